#include "features/base_level.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace rotrocc {
namespace {

constexpr int kFewFeatures = 100;
constexpr int kManyFeatures = 10000;

/// Rectangles over rectangles of all sizes, as seen by a sharp camera.
cv::Mat sharpImage(const cv::Size& size) {
  cv::Mat fine(size * 2, CV_8UC1, cv::Scalar(128));
  cv::RNG random(1);
  for (int i = 0; i < 4000; ++i) {
    const int side = 160 / random.uniform(1, 20);
    const cv::Rect place(random.uniform(-side, fine.cols),
                         random.uniform(-side, fine.rows),
                         side,
                         side / 2 + random.uniform(0, side));
    cv::rectangle(fine, place, cv::Scalar(random.uniform(40, 216)), cv::FILLED);
  }
  cv::Mat image;
  cv::resize(fine, image, size, 0.0, 0.0, cv::INTER_AREA);
  return image;
}

/// With `sigma` of noise.
void observe(const cv::Mat& image, double sigma, BaseLevel& base) {
  cv::Mat noise(image.size(), CV_16S);
  cv::RNG(2).fill(noise, cv::RNG::NORMAL, 0.0, sigma);
  cv::Mat noisy;
  cv::add(image, noise, noisy, cv::noArray(), CV_8U);
  ImagePyramid pyramid;
  buildPyramid(noisy, BaseLevel::kLevels, 9, pyramid);
  base.observe(noisy, pyramid);
}

cv::Mat enlarged(const cv::Mat& image, double factor) {
  cv::Mat result;
  cv::resize(image, result, {}, factor, factor, cv::INTER_CUBIC);
  return result;
}

TEST(BaseLevelTest, IsThatOfTheSmallestImageWithAllDetails) {
  const cv::Mat image = sharpImage({320, 256});
  for (const double sigma : {0.5, 2.0}) {
    for (int level = 0; level <= BaseLevel::kMaxLevel; ++level) {
      BaseLevel base({kFewFeatures});
      observe(enlarged(image, 1 << level), sigma, base);
      EXPECT_EQ(base.level(), level) << sigma;
      if (level == 0) {
        EXPECT_EQ(base.detail_px(), 1.0);
      }
    }
  }
}

TEST(BaseLevelTest, HalvesSharpImagesOnRequestWhereWindowsFit) {
  for (const int width : {640, 160}) {
    BaseLevel base({kFewFeatures, kFewFeatures, 1});
    observe(sharpImage({width, width}), 1.0, base);
    EXPECT_EQ(base.level(), width == 640 ? 1 : 0);
  }
}

TEST(BaseLevelTest, HalvesSharpImagesOnRequestOnlyWhileFewFeaturesAreWanted) {
  const cv::Mat image = sharpImage({640, 512});
  BaseLevel base({1000, kFewFeatures, 1});
  for (const double share : {0.0, 1.0, 0.0}) {
    base.observeSurvivors(share);
    observe(image, 1.0, base);
    EXPECT_EQ(base.level(), share == 1.0 ? 1 : 0);
  }
}

TEST(BaseLevelTest, WantsAsManyFeaturesAsItsInliersNeed) {
  BaseLevel base({400, 200, 0});
  EXPECT_EQ(base.wantedFeatures(), 400) << "nothing is known";
  base.observeSurvivors(0.8);
  EXPECT_EQ(base.wantedFeatures(), 250);
  base.observeSurvivors(0.6);
  EXPECT_EQ(base.wantedFeatures(), 333) << "at once";
  base.observeSurvivors(0.8);
  EXPECT_LT(base.wantedFeatures(), 333);
  EXPECT_GT(base.wantedFeatures(), 300) << "one pair shows little";
  for (int i = 0; i < 40; ++i) base.observeSurvivors(0.8);
  EXPECT_EQ(base.wantedFeatures(), 250);
  base.observeSurvivors(0.1);
  EXPECT_EQ(base.wantedFeatures(), 400) << "the maximum";
  base.observeSurvivors(0.0);
  base.observeSurvivors(0.8);
  EXPECT_EQ(base.wantedFeatures(), 250) << "of the first motion";
  EXPECT_EQ(BaseLevel({100, 200, 0}).wantedFeatures(), 100);
}

TEST(BaseLevelTest, WithoutRoomWindowsGrowWithTheImage) {
  for (const double factor : {1.25, 1.5, 2.0}) {
    const cv::Mat image = enlarged(sharpImage({320, 256}), factor);
    BaseLevel base({static_cast<int>(image.total()) / 270});  // a bit more than three windows
    observe(image, 1.0, base);
    EXPECT_EQ(base.level(), 0) << factor;
    EXPECT_NEAR(base.detail_px() / factor, 1.0, 0.25);  // that is a pixel of the window's radius
    EXPECT_EQ(base.window_scale(), base.detail_px());
  }
}

TEST(BaseLevelTest, DoublesImagesWithoutRoomAndSoftOnesLater) {
  constexpr int kFeaturesWithRoom = 200;
  constexpr int kFeaturesWithRoomIfSoft = 400;
  const cv::Mat sharp = sharpImage({320, 256});
  const cv::Mat soft = enlarged(sharpImage({160, 128}), 2.0);
  const auto levelOf = [](const cv::Mat& image, const FeatureDetectorConfig& config) {
    BaseLevel base(config);
    observe(image, 1.0, base);
    return base.level();
  };
  EXPECT_EQ(levelOf(sharp, {kFeaturesWithRoom}), 0);
  EXPECT_EQ(levelOf(sharp, {kFeaturesWithRoomIfSoft}), -1);
  EXPECT_EQ(levelOf(soft, {kFeaturesWithRoomIfSoft}), 0);
  EXPECT_EQ(levelOf(soft, {kManyFeatures}), -1);
}

TEST(BaseLevelTest, DoublingEnlargesDetailsButNotTheWindowsOfMany) {
  const cv::Mat sharp = sharpImage({320, 256});
  for (const int features : {400, kManyFeatures}) {
    BaseLevel base({features});
    observe(sharp, 1.0, base);
    EXPECT_EQ(base.detail_px(), 2.0);
    EXPECT_GE(base.window_scale(), 1.0);
    EXPECT_LT(base.window_scale(), features == 400 ? 2.0 : 1.01);
  }
}

TEST(BaseLevelTest, OneBlurredImageAmongSharpOnesChangesNothing) {
  const cv::Mat image = sharpImage({640, 512});
  cv::Mat blurred;
  cv::GaussianBlur(image, blurred, {}, 2.0);
  BaseLevel base({kFewFeatures});
  for (int i = 0; i < 20; ++i) observe(image, 1.0, base);
  observe(blurred, 1.0, base);
  EXPECT_EQ(base.level(), 0);
  for (int i = 0; i < 40; ++i) observe(blurred, 1.0, base);
  EXPECT_GT(base.level(), 0);
}

TEST(BaseLevelTest, BlackAndTinyImagesHaveALevel) {
  BaseLevel base({kFewFeatures});
  observe(cv::Mat::zeros(200, 300, CV_8UC1), 0.0, base);
  EXPECT_EQ(base.level(), 0);
  observe(cv::Mat::zeros(8, 8, CV_8UC1), 0.0, base);
  EXPECT_EQ(base.level(), -1);
}

}  // namespace
}  // namespace rotrocc
