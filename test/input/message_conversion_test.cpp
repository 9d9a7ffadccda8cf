#include "input/message_conversion.h"

#include <cv_bridge/cv_bridge.h>
#include <gtest/gtest.h>

namespace rotrocc {
namespace {

TEST(MessageConversionTest, KeepsEveryNanosecond) {
  const ros::Time stamp(1'317'384'506, 123'456'789);
  EXPECT_EQ(toNanoseconds(stamp), 1'317'384'506'123'456'789);
  EXPECT_EQ(toRosTime(toNanoseconds(stamp)), stamp);
}

TEST(MessageConversionTest, ImagesAreThoseOfCvBridge) {
  std_msgs::Header header;
  header.frame_id = "camera";
  header.stamp = ros::Time(12, 34);
  cv::Mat grey(20, 30, CV_8UC1);
  cv::Mat colours(20, 30, CV_8UC3);
  cv::RNG random(1);
  random.fill(grey, cv::RNG::UNIFORM, 0, 256);
  random.fill(colours, cv::RNG::UNIFORM, 0, 256);
  const cv::Rect part(3, 4, 11, 12);
  for (const cv::Mat& pixels : {grey, grey(part), colours, colours(part)}) {
    const std::string encoding = pixels.channels() == 1 ? "mono8" : "bgr8";
    EXPECT_EQ(*toImage(header, encoding, pixels),
              *cv_bridge::CvImage(header, encoding, pixels).toImageMsg());
  }
}

}  // namespace
}  // namespace rotrocc
