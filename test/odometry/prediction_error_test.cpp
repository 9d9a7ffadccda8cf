#include "odometry/prediction_error.h"

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

/// Windows of 4 px, 2 to 5 levels: the search reaches 8, 16, 32 and 64 px.
FeatureTrackerConfig config() {
  FeatureTrackerConfig config;
  config.window_radius_px = 4;
  config.levels = 2;
  config.startup_levels = 5;
  return config;
}

int levelsAfter(double error_px) {
  PredictionError error(config());
  error.observe(error_px);
  return error.levels();
}

TEST(PredictionErrorTest, SearchesTwiceAsFarAsTheLastError) {
  EXPECT_EQ(PredictionError(config()).levels(), 2);
  EXPECT_EQ(levelsAfter(3.9), 2);
  EXPECT_EQ(levelsAfter(4.1), 3);
  EXPECT_EQ(levelsAfter(15.0), 4);
  EXPECT_EQ(levelsAfter(1000.0), 5);
}

TEST(PredictionErrorTest, ForgetsAnErrorSlowly) {
  PredictionError error(config());
  error.observe(7.0);
  error.observe(0.1);  // 7 px counts as 5.6
  EXPECT_EQ(error.levels(), 3);
  for (int i = 0; i < 3; ++i) error.observe(0.1);
  EXPECT_EQ(error.levels(), 2);
}

TEST(PredictionErrorTest, StartsAgainAfterAReset) {
  PredictionError error(config());
  error.observe(100.0);
  error.reset();
  EXPECT_EQ(error.levels(), 2);
}

}  // namespace
}  // namespace rotrocc
