#include "rectification/image_resampler.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace rotrocc {
namespace {

constexpr int kSide = 3;  // too small for a pixel with all its neighbours
constexpr int kMargin = 4;
constexpr int kPlaces = 400;

/// Pixels that lack neighbours take those of the border, one by one. With a border around the
/// image, registers take them.
TEST(ImageResamplerTest, BorderAndMiddleAreTheSameSums) {
  cv::RNG random(3);
  for (int round = 0; round < 20; ++round) {
    cv::Mat small(kSide, kSide, CV_8UC1);
    random.fill(small, cv::RNG::UNIFORM, 0, 256);
    if (round == 0) small = 255 * (small > 127);  // overshoots
    cv::Mat large;
    cv::copyMakeBorder(small, large, kMargin, kMargin, kMargin, kMargin, cv::BORDER_REPLICATE);
    ImageResampler of_small(small.size(), {kPlaces, 1});
    ImageResampler of_large(large.size(), {kPlaces, 1});
    for (int i = 0; i < kPlaces; ++i) {
      const Eigen::Vector2d place(random.uniform(0.0, kSide - 1.0),
                                  random.uniform(0.0, kSide - 1.0));
      of_small.setPlace(i, 0, place);
      of_large.setPlace(i, 0, place + Eigen::Vector2d::Constant(kMargin));
    }
    cv::Mat from_small(1, kPlaces, CV_8UC1), from_large(1, kPlaces, CV_8UC1);
    of_small.resample(small, from_small);
    of_large.resample(large, from_large);
    EXPECT_EQ(cv::norm(from_small, from_large, cv::NORM_INF), 0.0) << round;
  }
}

}  // namespace
}  // namespace rotrocc
