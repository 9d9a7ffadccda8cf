#include "node/health/exposure_watch.h"

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

constexpr int kPairs = ExposureWatch::kPairs;

OdometryResult pairWith(double gain) {
  OdometryResult result;
  result.state = State::kOk;
  result.exposure_gain = gain;
  return result;
}

/// The hint after `count` pairs of the same gain.
std::string observe(ExposureWatch& watch, double gain, int count) {
  std::string hint;
  for (int i = 0; i < count; ++i) hint = watch.observe(pairWith(gain));
  return hint;
}

TEST(ExposureWatchTest, IsSilentAboutCamerasThatAreAlike) {
  for (const double gain : {0.55, 1.0, 1.9}) {
    ExposureWatch watch;
    EXPECT_EQ(observe(watch, gain, kPairs), "");
  }
}

TEST(ExposureWatchTest, NamesTheRatioOfContrasts) {
  ExposureWatch watch;
  EXPECT_EQ(observe(watch, 0.4234, ExposureWatch::kLeastPairs - 1), "");
  EXPECT_EQ(observe(watch, 0.4234, 1),
            "the right camera's contrast is 0.42 times the left one's: couple the exposures of the "
            "cameras");
  EXPECT_NE(observe(watch, 2.3, kPairs).find("is 2.3 times"), std::string::npos);
  EXPECT_EQ(observe(watch, 1.0, kPairs), "") << "the fault is gone";
}

TEST(ExposureWatchTest, SeesARatioThatMoves) {
  ExposureWatch watch;
  std::string hint;
  for (int i = 0; i < kPairs; ++i) hint = watch.observe(pairWith(i % 4 < 2 ? 0.7 : 1.51));
  EXPECT_EQ(hint,
            "the right camera's contrast moves between 0.7 and 1.51 times the left one's: couple "
            "the exposures of the cameras");
}

TEST(ExposureWatchTest, IgnoresSinglePairsAndThoseWithoutAMotion) {
  ExposureWatch watch;
  observe(watch, 1.0, kPairs);
  EXPECT_EQ(observe(watch, 4.0, 3), "");
  OdometryResult lost;
  for (int i = 0; i < kPairs; ++i) EXPECT_EQ(watch.observe(lost), "");
}

}  // namespace
}  // namespace rotrocc
