#include "input/message_conversion.h"

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

TEST(MessageConversionTest, KeepsEveryNanosecond) {
  const ros::Time stamp(1'317'384'506, 123'456'789);
  EXPECT_EQ(toNanoseconds(stamp), 1'317'384'506'123'456'789);
  EXPECT_EQ(toRosTime(toNanoseconds(stamp)), stamp);
}

TEST(MessageConversionTest, ImagesHaveRowsWithoutPadding) {
  std_msgs::Header header;
  header.frame_id = "camera";
  cv::Mat colours(20, 30, CV_8UC3);
  cv::randu(colours, 0, 256);
  for (const cv::Mat& pixels : {colours, colours(cv::Rect(3, 4, 11, 12))}) {
    const sensor_msgs::Image::Ptr image = toImage(header, "bgr8", pixels);
    EXPECT_EQ(image->header, header);
    EXPECT_EQ(image->encoding, "bgr8");
    EXPECT_EQ(image->step, 3 * image->width);
    EXPECT_EQ(image->data.size(), 3 * pixels.total());
    const cv::Size size(static_cast<int>(image->width), static_cast<int>(image->height));
    EXPECT_EQ(cv::norm(cv::Mat(size, CV_8UC3, image->data.data()), pixels, cv::NORM_INF), 0.0);
  }
}

}  // namespace
}  // namespace rotrocc
