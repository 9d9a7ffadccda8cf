/// The whole pipeline on each simulated scenario, against exact truth.

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "rotrocc/visual_odometry.h"
#include "simulation/drives/scenario.h"
#include "simulation/simulator.h"
#include "support/slow_build.h"

namespace rotrocc {
namespace {

struct Step {
  OdometryResult estimate;
  Eigen::Isometry3d T_prev_cur_true;
};

/// The motions between `pairs` pairs of a drive, from `first` on.
std::vector<Step> drive(Simulator& simulator, int first, int pairs) {
  VisualOdometry odometry{VisualOdometry::Config{}};
  std::vector<Step> steps;
  for (int i = first; i < first + pairs; ++i) {
    const auto result = odometry.process(simulator.render(i, false).pair, simulator.camera());
    if (i == first) continue;
    steps.push_back({result, simulator.pose(i - 1).inverse() * simulator.pose(i)});
  }
  return steps;
}

/// The same in the middle of a scenario, where the car drives.
std::vector<Step> drive(const std::string& name, const SimulationOptions& options, int pairs) {
  Simulator simulator(scenario(name, 1), options);
  return drive(simulator, simulator.size() / 4, pairs);
}

/// Noise of the images over that of a fine day, 2 grey levels: 500 electrons for white and 8 of
/// read noise make 7 of them at a brightness of 0.15.
double noiseOf(const std::string& name) {
  return name == "night" ? 3.5 : 1.0;
}

class ScenarioAccuracyTest : public ::testing::TestWithParam<std::string> {};

TEST_P(ScenarioAccuracyTest, FollowsTheDriveWithoutABias) {
  SimulationOptions options;
  if (GetParam() == "handheld") options.rate_hz = 20.0;  // 10 Hz needs a gyroscope
  std::vector<double> errors;
  for (const Step& step : drive(GetParam(), options, isSlowBuild() ? 5 : 13)) {
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

/// That of EuRoC.
StereoCamera indoorCamera() {
  StereoCamera camera;
  camera.width = 752;
  camera.height = 480;
  camera.fx = camera.fy = 460.0;
  camera.cx = camera.cx_right = 375.5;
  camera.cy = 239.5;
  camera.baseline_m = 0.11;
  return camera;
}

/// One of the hardest short parts of the hall, and limits of the error at its end: twice the
/// largest error of five seeds.
struct HallPart {
  std::string name;
  double start_s;
  bool worn;
  double limit_mm;
  double limit_mrad;
};

void PrintTo(const HallPart& part, std::ostream* out) {
  *out << part.name;
}

class HallAccuracyTest : public ::testing::TestWithParam<HallPart> {};

TEST_P(HallAccuracyTest, FollowsThePart) {
  SimulationOptions options;
  options.camera = indoorCamera();
  options.rate_hz = 20.0;
  options.worn_rig = GetParam().worn;
  Simulator simulator(scenario("hall", 1), options);
  const int first = static_cast<int>(std::lround(GetParam().start_s * options.rate_hz));
  Eigen::Isometry3d T_first_now = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();
  for (const Step& step : drive(simulator, first, isSlowBuild() ? 4 : 10)) {
    ASSERT_TRUE(step.estimate.hasMotion()) << step.estimate.reason;
    T_first_now = T_first_now * step.estimate.T_prev_cur;
    truth = truth * step.T_prev_cur_true;
  }
  const Eigen::Isometry3d error = truth.inverse() * T_first_now;
  EXPECT_LT(1e3 * error.translation().norm(), GetParam().limit_mm);
  EXPECT_LT(1e3 * Eigen::AngleAxisd(error.linear()).angle(), GetParam().limit_mrad);
}

INSTANTIATE_TEST_SUITE_P(Hall,
                         HallAccuracyTest,
                         ::testing::Values(HallPart{"TurnOf100DegPerS", 9.9, false, 2.1, 0.4},
                                           HallPart{"TurnWithAWornRig", 9.9, true, 54.0, 9.0},
                                           HallPart{"Wall", 17.9, false, 1.7, 0.3},
                                           HallPart{"WallWithAWornRig", 17.9, true, 22.0, 0.8}),
                         [](const auto& part) { return part.param.name; });

}  // namespace
}  // namespace rotrocc
