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

TEST(HalfImageTest, TakesPartsOfImagesAndUsesMemoryAgain) {
  cv::Mat whole(60, 90, CV_8UC1);
  cv::RNG(2).fill(whole, cv::RNG::UNIFORM, 0, 256);
  const cv::Mat part = whole(cv::Rect(7, 5, 61, 40));
  cv::Mat of_part, of_copy;
  halve(part, of_part);
  const uchar* memory = of_part.data;
  halve(part, of_part);
  EXPECT_EQ(of_part.data, memory);
  halve(part.clone(), of_copy);
  EXPECT_EQ(cv::norm(of_part, of_copy, cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace rotrocc
