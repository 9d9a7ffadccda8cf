#pragma once

#include <cstdint>
#include <string>

#include <sensor_msgs/Image.h>
#include <sensor_msgs/fill_image.h>
#include <boost/make_shared.hpp>
#include <opencv2/core.hpp>

namespace rotrocc {

/// The message that cv_bridge makes of 8-bit pixels, without its library: that loads 120 others,
/// for image files.
inline sensor_msgs::Image::Ptr toImage(const std_msgs::Header& header,
                                       const std::string& encoding,
                                       const cv::Mat& pixels) {
  const cv::Mat packed = pixels.isContinuous() ? pixels : pixels.clone();
  const auto image = boost::make_shared<sensor_msgs::Image>();
  image->header = header;
  sensor_msgs::fillImage(*image,
                         encoding,
                         static_cast<std::uint32_t>(packed.rows),
                         static_cast<std::uint32_t>(packed.cols),
                         static_cast<std::uint32_t>(packed.step),
                         packed.data);
  return image;
}

}  // namespace rotrocc
