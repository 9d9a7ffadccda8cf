/// The whole pipeline on each simulated scenario, against exact truth.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "rotrocc/visual_odometry.h"
#include "simulation/drives/scenario.h"
#include "simulation/simulator.h"
#include "support/slow_build.h"

namespace rotrocc {
namespace {

int pairsToDrive() {
  return isSlowBuild() ? 5 : 13;
}

struct Step {
  OdometryResult estimate;
  Eigen::Isometry3d T_prev_cur_true;
};

/// The motions between pairs in the middle of a scenario, where the car drives.
std::vector<Step> drive(const std::string& name) {
  SimulationOptions options;
  if (name == "handheld") options.rate_hz = 20.0;  // 10 Hz needs a gyroscope
  Simulator simulator(scenario(name, 1), options);
  const int first = simulator.size() / 4;
  VisualOdometry odometry{VisualOdometry::Config{}};
  std::vector<Step> steps;
  for (int i = first; i < first + pairsToDrive(); ++i) {
    const auto result = odometry.process(simulator.render(i, false).pair, simulator.camera());
    if (i == first) continue;
    steps.push_back({result, simulator.pose(i - 1).inverse() * simulator.pose(i)});
  }
  return steps;
}

/// The row offset estimated for a rig whose right camera is turned, and its true value at infinity.
struct TurnedRig {
  RowOffset found;
  double lower_px;
};

TurnedRig turnRightCamera(double roll_rad, double pitch_rad) {
  SimulationOptions options;
  options.faults.right_rotation_rad = {roll_rad, pitch_rad, 0.0};
  Simulator simulator(scenario("city", 1), options);
  const int first = simulator.size() / 4;
  VisualOdometry odometry{VisualOdometry::Config{}};
  TurnedRig rig;
  for (int i = first; i < first + 4; ++i) {
    rig.found = odometry.process(simulator.render(i, false).pair, simulator.camera()).row_offset;
  }
  const Eigen::Vector3d far(0.0, 0.0, 1e6);
  const StereoCamera& camera = simulator.camera();
  rig.lower_px =
      (camera.project(options.faults.rightCamera(camera).inverse() * far) - camera.project(far))
          .y();
  return rig;
}

TEST(TurnedRigTest, ShowsInTheRows) {
  const TurnedRig good = turnRightCamera(0.0, 0.0);
  // The median of a few hundred features, each measured to 0.1 px.
  EXPECT_NEAR(good.found.median_px, 0.0, 0.02);
  EXPECT_LT(good.found.typical_px, 0.1);

  const TurnedRig pitched = turnRightCamera(0.0, 0.001);
  EXPECT_GT(std::abs(pitched.lower_px), 0.5);
  EXPECT_NEAR(pitched.found.median_px, pitched.lower_px, 0.05);
  EXPECT_NEAR(pitched.found.typical_px, std::abs(pitched.lower_px), 0.05);

  // Up on one side, down on the other: up to 1.2 px at the edges.
  const TurnedRig rolled = turnRightCamera(0.002, 0.0);
  EXPECT_LT(std::abs(rolled.found.median_px), 0.4);
  EXPECT_GT(rolled.found.typical_px, 0.2);
}

TEST(SkewedRigTest, ShowsInTheRowsOfMovingFeatures) {
  for (const double skew_s : {0.0, 0.005}) {
    SimulationOptions options;
    options.faults.time_skew_s = skew_s;
    Simulator simulator(scenario("shake", 1), options);
    const int first = simulator.size() / 4;
    VisualOdometry odometry{VisualOdometry::Config{}};
    TimeSkew skew;
    for (int i = first; i < first + 16; ++i) {
      skew = odometry.process(simulator.render(i, false).pair, simulator.camera()).time_skew;
    }
    // Most of sigma is the floor that lenses ask for, which these do not have.
    ASSERT_GT(skew.sigma_s, 0.0);
    EXPECT_LT(skew.sigma_s, 0.001);
    EXPECT_NEAR(skew.estimated_s, skew_s, 0.2 * skew_s + 0.0002);
  }
}

/// Noise of the images over that of a fine day, 2 grey levels: 500 electrons for white and 8 of
/// read noise make 7 of them at a brightness of 0.15.
double noiseOf(const std::string& name) {
  return name == "night" ? 3.5 : 1.0;
}

class ScenarioAccuracyTest : public ::testing::TestWithParam<std::string> {};

TEST_P(ScenarioAccuracyTest, FollowsTheDriveWithoutABias) {
  std::vector<double> errors;
  for (const Step& step : drive(GetParam())) {
    ASSERT_TRUE(step.estimate.hasMotion()) << step.estimate.reason;
    const double length_m = step.T_prev_cur_true.translation().norm();
    ASSERT_GT(length_m, 0.0);
    errors.push_back(step.estimate.T_prev_cur.translation().norm() / length_m - 1.0);
    const Eigen::AngleAxisd turn_error(step.T_prev_cur_true.linear().transpose() *
                                       step.estimate.T_prev_cur.linear());
    // Far more than the error of the mean of hundreds of features.
    EXPECT_LT(turn_error.angle(), noiseOf(GetParam()) * 0.15 / kittiCamera().fx);
  }

  double mean = 0.0;
  double squares = 0.0;
  for (const double error : errors) {
    mean += error / static_cast<double>(errors.size());
    squares += error * error;
  }
  // The bias over a whole drive must be less than 0.3 %; this short part of it has a mean that is
  // uncertain by its steps' errors.
  const double uncertainty = std::sqrt(squares) / static_cast<double>(errors.size());
  EXPECT_LT(std::abs(mean), 0.003 + 3.0 * uncertainty);
  EXPECT_LT(uncertainty, 0.003 * noiseOf(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(
    Scenarios,
    ScenarioAccuracyTest,
    ::testing::Values("city", "motorway", "slip_road", "parking", "shake", "handheld", "night"),
    [](const auto& name) { return name.param; });

}  // namespace
}  // namespace rotrocc
