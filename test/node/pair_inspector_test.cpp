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
      result.exposure_gain = gain;
      result.counts.corners = 1000;
      hint = inspector_.inspect({0, image_, image_}, StereoCamera(), result);
    }
    return hint;
  }

  PairInspector inspector_{CorrespondenceFinder::Config()};
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
  EXPECT_EQ(inspect(4.0, kPairs, State::kInitialising), "");
}

TEST(DarkImagesTest, TheHintNamesTheRangeOf16BitImages) {
  PairInspector inspector{CorrespondenceFinder::Config()};
  cv::Mat image = cv::Mat::zeros(48, 64, CV_8UC1);
  OdometryResult lost;
  lost.state = State::kLost;
  lost.counts.tries = 1;
  const auto inspect = [&] {
    return inspector.inspect({0, image, image}, StereoCamera(), lost, 10);
  };
  for (int pair = 0; pair < PairInspector::kPatience; ++pair) {
    image += 1;
    inspect();
  }
  inspector.finish();
  const std::string hint = inspect();
  EXPECT_NE(hint.find("mean grey level is 10 of 255, where 255 is 1023 of the 16-bit image: set "
                      "significant_bits"),
            std::string::npos)
      << hint;
}

}  // namespace
}  // namespace rotrocc
