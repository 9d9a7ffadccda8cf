#include "features/image_pyramid.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace rotrocc {
namespace {

TEST(HalfImageTest, IsThatOfOpenCvForAnySize) {
  cv::RNG generator(1);
  for (int width = 1; width < 40; ++width) {
    for (const int height : {1, 2, 3, 4, 7, 12}) {
      cv::Mat image(height, width, CV_8UC1);
      generator.fill(image, cv::RNG::UNIFORM, 0, 256);
      cv::Mat expected, half;
      cv::pyrDown(image, expected);
      halve(image, half);
      ASSERT_EQ(half.size(), expected.size());
      EXPECT_EQ(cv::norm(half, expected, cv::NORM_INF), 0.0) << image.size();
    }
  }
}

}  // namespace
}  // namespace rotrocc
