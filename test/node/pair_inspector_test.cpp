#include "node/health/pair_inspector.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace rotrocc
