#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace rotrocc {

/// What the library rotrocc_image_codecs can do, see image_codecs.h.
struct OpenCvCodecs {
  cv::Mat (*read_grey)(const std::string& path);
  std::vector<unsigned char> (*encode)(const std::string& extension, const cv::Mat& image);
};

}  // namespace rotrocc

extern "C" {
extern const rotrocc::OpenCvCodecs rotrocc_image_codecs;
}
