#include "features/exposure.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support/synthetic_scene.h"

namespace rotrocc {
namespace {

const StereoPair& street() {
  static const StereoPair pair = [] {
    StereoPair rendered = SyntheticScene().render(Eigen::Isometry3d::Identity(), 0);
    SyntheticScene::addNoise(rendered, 2.0, 1);
    return rendered;
  }();
  return pair;
}

cv::Mat exposed(const cv::Mat& image, double gain, double offset) {
  cv::Mat changed;
  image.convertTo(changed, -1, gain, offset);
  return changed;
}

TEST(ExposureTest, IsThatOfTheSecondImage) {
  for (const double gain : {0.5, 0.7, 1.0}) {
    for (const double offset : {0.0, 20.0}) {
      const cv::Mat changed = exposed(street().right, gain, offset);
      const Exposure there = compareExposures(street().left, changed);
      EXPECT_NEAR(there.gain, gain, 0.05 * gain);
      EXPECT_NEAR(there.offset, offset, 8.0);
      const Exposure back = compareExposures(changed, street().left);
      EXPECT_NEAR(back.gain, 1.0 / gain, 0.05 / gain);
    }
  }
}

TEST(ExposureTest, IgnoresSaturatedPixelsAndBlackMargins) {
  cv::Mat left = street().left.clone();
  cv::Mat right = exposed(street().right, 0.6, 0.0);
  const cv::Rect sky(0, 0, left.cols, left.rows / 4);
  const cv::Rect margin(0, 0, left.cols / 10, left.rows);
  for (cv::Mat* image : {&left, &right}) {
    (*image)(sky).setTo(255);
    (*image)(margin).setTo(0);
  }
  EXPECT_NEAR(compareExposures(left, right).gain, 0.6, 0.05);
}

TEST(ExposureTest, IsEqualWithoutTexture) {
  const cv::Mat plain(80, 300, CV_8UC1, cv::Scalar(80));
  EXPECT_EQ(compareExposures(plain, plain).gain, 1.0);
  EXPECT_EQ(compareExposures(plain, street().left(cv::Rect(0, 0, 300, 80))).gain, 1.0);
  EXPECT_EQ(compareExposures(cv::Mat(1, 1, CV_8UC1, cv::Scalar(9)),
                             cv::Mat(1, 1, CV_8UC1, cv::Scalar(90)))
                .offset,
            0.0);
}

TEST(WindowGainTest, IsTheMedian) {
  const cv::Mat& image = street().left;
  const cv::Mat darker = exposed(image, 0.6, 20.0);
  WindowGain gain;
  for (int i = 0; i < 30; ++i) {
    const cv::Point2f point(50.0F + 13.0F * static_cast<float>(i), 90.0F);
    const bool wrong = i % 4 == 0;
    gain.add(image, point, darker, wrong ? cv::Point2f(300.0F, 150.0F) : point);
  }
  // Grey levels are rounded.
  EXPECT_NEAR(gain.median(1.0), 0.6, 0.02);
}

TEST(WindowGainTest, NeedsAFewWindows) {
  const cv::Mat& image = street().left;
  const cv::Mat darker = exposed(image, 0.6, 0.0);
  WindowGain gain;
  EXPECT_EQ(gain.median(0.7), 0.7);
  for (int i = 0; i < 5; ++i) gain.add(image, {100.0F, 90.0F}, darker, {100.0F, 90.0F});
  EXPECT_EQ(gain.median(0.7), 0.7);
  for (int i = 0; i < 30; ++i) {
    gain.add(image, {2.0F, 90.0F}, darker, {100.0F, 90.0F});
    gain.add(image, {100.0F, 90.0F}, darker, {100.0F, -1e6F});
  }
  EXPECT_EQ(gain.median(0.7), 0.7) << "windows beyond the border";
}

TEST(WindowGainTest, SamplesTheWholeList) {
  for (const std::size_t count : {0u, 1u, 63u, 64u, 127u, 128u, 2000u}) {
    const std::size_t step = WindowGain::step(count);
    const std::size_t sample = (count + step - 1) / step;
    EXPECT_GE(sample, std::min(count, WindowGain::kSample)) << count;
    EXPECT_LT(sample, 2 * WindowGain::kSample) << count;
  }
}

TEST(BeyondNoiseTest, KeepsEqualExposuresEqual) {
  EXPECT_EQ(beyondNoise(1.04, 0.05), 1.0);
  EXPECT_EQ(beyondNoise(0.96, 0.05), 1.0);
  EXPECT_EQ(beyondNoise(1.06, 0.05), 1.06);
  EXPECT_EQ(beyondNoise(0.9, 0.05), 0.9);
}

}  // namespace
}  // namespace rotrocc
