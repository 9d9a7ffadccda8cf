#include "node/health/pair_inspector.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "support/synthetic_scene.h"

namespace rotrocc {
namespace {

constexpr int kPairs = PairInspector::kExposures;

/// Of pairs that are OK but for their exposures.
class ExposuresTest : public testing::Test {
 protected:
  /// The hint after `count` pairs of the same gain, or without a motion.
  std::string inspect(double gain, int count = 1, State state = State::kOk) {
    std::string hint;
    for (int i = 0; i < count; ++i) {
      OdometryResult result;
      result.state = state;
      result.contrast_gain = gain;
      result.counts.corners = 1000;
      hint = inspector_.inspect({0, image_, image_}, StereoCamera(), result);
    }
    return hint;
  }

  PairInspector inspector_{OdometryConfig()};
  const cv::Mat image_ = cv::Mat::zeros(8, 8, CV_8UC1);
};

TEST_F(ExposuresTest, IsSilentAboutCamerasThatAreAlike) {
  for (const double gain : {0.55, 1.0, 1.9}) EXPECT_EQ(inspect(gain, kPairs), "");
}

TEST_F(ExposuresTest, NamesTheRatioOfContrasts) {
  EXPECT_EQ(inspect(0.4234, PairInspector::kMinExposures - 1), "");
  EXPECT_EQ(inspect(0.4234),
            "the right camera's contrast is 0.42 times the left one's: couple the exposures of the "
            "cameras");
  EXPECT_NE(inspect(2.3, kPairs).find("is 2.3 times"), std::string::npos);
  EXPECT_EQ(inspect(1.0, kPairs), "") << "the fault is gone";
}

TEST_F(ExposuresTest, SeesARatioThatMoves) {
  std::string hint;
  for (int i = 0; i < kPairs; ++i) hint = inspect(i % 4 < 2 ? 0.7 : 1.51);
  EXPECT_EQ(hint,
            "the right camera's contrast moves between 0.7 and 1.51 times the left one's: couple "
            "the exposures of the cameras");
}

TEST_F(ExposuresTest, IgnoresSinglePairsAndThoseWithoutAMotion) {
  inspect(1.0, kPairs);
  EXPECT_EQ(inspect(4.0, 3), "");
  EXPECT_EQ(inspect(4.0, kPairs, State::kInitializing), "");
}

/// Of dark images whose motion is lost.
class DarkImagesTest : public testing::Test {
 protected:
  std::string inspect(State state = State::kLost) {
    image_ += 1;
    OdometryResult result;
    result.state = state;
    result.contrast_gain = 1.0;
    result.counts.tries = 1;
    return inspector_.inspect({0, image_, image_}, StereoCamera(), result, {0, 10});
  }
  std::string inspectAll(int count, State state = State::kLost) {
    for (int i = 1; i < count; ++i) inspect(state);
    return inspect(state);
  }

  PairInspector inspector_{OdometryConfig()};
  cv::Mat image_ = cv::Mat::zeros(48, 64, CV_8UC1);
};

TEST_F(DarkImagesTest, TheHintNamesTheRangeOf16BitImages) {
  inspectAll(PairInspector::kPatience);
  inspector_.finish();
  const std::string hint = inspect();
  EXPECT_NE(hint.find("mean gray level is 10 of 255, where 0 is 0 and 255 is 1023 of the 16-bit "
                      "image: set significant_bits"),
            std::string::npos)
      << hint;
}

TEST_F(DarkImagesTest, AChanceMatchEndsNoHint) {
  inspectAll(PairInspector::kPatience - 1);
  EXPECT_EQ(inspect(State::kOk), "");
  inspectAll(2);
  inspector_.finish();
  EXPECT_NE(inspect(), "");
  inspectAll(PairInspector::kPatience, State::kOk);
  EXPECT_EQ(inspect(), "");
}

TEST_F(DarkImagesTest, AHintOfALongLossEndsSoon) {
  inspectAll(30 * PairInspector::kPatience);
  inspector_.finish();
  EXPECT_NE(inspect(), "");
  inspectAll(4 * PairInspector::kPatience, State::kOk);
  EXPECT_EQ(inspect(), "");
}

TEST_F(DarkImagesTest, SingleDoubtfulPairsCauseNoHint) {
  for (int i = 0; i < 3 * PairInspector::kPatience; ++i) {
    EXPECT_EQ(inspect(State::kDegraded), "");
    inspect(State::kOk);
    inspector_.finish();
  }
}

/// Of pairs that are lost, with as many corners as there is room for.
class TexturedImagesTest : public testing::Test {
 protected:
  TexturedImagesTest() {
    camera_.height = 480;  // a sixteenth of the rows are searched
    result_.state = State::kLost;
    result_.contrast_gain = 1.0;
    result_.counts.tries = 1;
  }

  /// Sets the right image so many rows lower. `detail_px`: Gaussian sigma of the smallest detail.
  void lower(int rows, double detail_px) {
    constexpr int kMargin_px = 60;
    constexpr int kDisparity_px = 20;
    const cv::Size size(camera_.width, camera_.height);
    cv::Mat scene(size + cv::Size(2 * kMargin_px, 2 * kMargin_px), CV_32FC1);
    cv::RNG random(1);
    random.fill(scene, cv::RNG::NORMAL, 0.0, 1.0);
    cv::GaussianBlur(scene, scene, {}, detail_px);
    cv::normalize(scene, scene, 0.0, 255.0, cv::NORM_MINMAX, CV_8U);
    pair_.left = scene(cv::Rect({kMargin_px, kMargin_px}, size));
    pair_.right = scene(cv::Rect({kMargin_px + kDisparity_px, kMargin_px - rows}, size));
  }

  /// The hint if right images are so many rows lower, of which `corrected` are corrected.
  std::string hintOfRows(int rows, double detail_px, int halvings, int corrected = 0) {
    lower(rows, detail_px);
    result_.halvings = halvings;
    result_.row_offset.applied_px = corrected;
    inspector_.reset();
    inspect(PairInspector::kPatience);
    return inspector_.finish();
  }

  void inspect(int count) {
    for (int i = 0; i < count; ++i) inspector_.inspect(pair_, camera_, result_);
  }

  PairInspector inspector_{OdometryConfig()};
  StereoPair pair_;
  StereoCamera camera_ = SyntheticScene::defaultCamera();
  OdometryResult result_;
};

TEST_F(TexturedImagesTest, NamesRowsInPixelsOfTheImage) {
  constexpr char kShifted[] = "the images match if the right one is shifted by about ";
  for (const int halvings : {-1, 0, 1}) {
    for (int rows : {-12, -6, 5, 9}) {
      rows *= halvings > 0 ? 2 : 1;
      const std::string hint = hintOfRows(rows, 2.0 * (1 + std::max(halvings, 0)), halvings);
      ASSERT_EQ(hint.rfind(kShifted, 0), 0U) << rows << ": " << hint;
      // Each second row is tried, and windows match in the rows beside theirs.
      EXPECT_NEAR(std::stoi(hint.substr(sizeof(kShifted) - 1)), -rows, halvings > 0 ? 4 : 2);
    }
  }
}

TEST_F(TexturedImagesTest, WhatMatchesByChanceIsNoPair) {
  const std::string hint = hintOfRows(50, 4.0, 1);
  EXPECT_EQ(hint.rfind("hardly any corner matches in the right image, except by chance", 0), 0U)
      << hint;
}

TEST_F(TexturedImagesTest, AGuessDoesNotReplaceAnExplanationAtOnce) {
  const std::string explained = hintOfRows(10, 2.0, 0);
  ASSERT_NE(explained, "");
  lower(50, 2.0);
  inspect(PairInspector::kPatience);
  EXPECT_EQ(inspector_.finish(), explained);
  inspect(2 * PairInspector::kPatience);
  EXPECT_NE(inspector_.finish().find("except by chance"), std::string::npos);
}

TEST_F(TexturedImagesTest, RowsThatMatchExplainNothing) {
  EXPECT_EQ(hintOfRows(0, 2.0, 0), "");
  EXPECT_EQ(hintOfRows(0, 4.0, 1), "");
  EXPECT_EQ(hintOfRows(8, 4.0, 1, 8), "") << "they are corrected";
}

TEST_F(TexturedImagesTest, SaysThatSeveralPairsShowNoCause) {
  EXPECT_EQ(hintOfRows(0, 2.0, 0), "");
  EXPECT_FALSE(inspector_.isUnexplained()) << "not each pair shows it";
  inspect(PairInspector::kPatience);
  EXPECT_EQ(inspector_.finish(), "");
  EXPECT_TRUE(inspector_.isUnexplained());
  EXPECT_NE(hintOfRows(10, 2.0, 0), "");
  EXPECT_FALSE(inspector_.isUnexplained());
}

}  // namespace
}  // namespace rotrocc
