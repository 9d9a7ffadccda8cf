// The whole pipeline on the hardest short parts of the hall.

#include <cmath>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "rotrocc/visual_odometry.h"
#include "simulation/drives/scenario.h"
#include "simulation/simulator.h"
#include "support/slow_build.h"

namespace rotrocc {
namespace {

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

/// Of the error at the end of a part.
struct Limits {
  double mm;
  double mrad;
};

/// Limits are twice the largest error of five seeds.
struct Part {
  std::string name;
  double start_s;
  Limits perfect;
  Limits worn;
};

void PrintTo(const Part& part, std::ostream* out) {
  *out << part.name;
}

class PlaceAccuracyTest : public ::testing::TestWithParam<Part> {};

TEST_P(PlaceAccuracyTest, FollowsThePart) {
  const Part& part = GetParam();
  const int pairs = isSlowBuild() ? 4 : 10;
  for (const bool worn : {false, true}) {
    SimulationOptions options;
    options.camera = indoorCamera();
    options.rate_hz = 20.0;
    options.worn_rig = worn;
    Simulator simulator(scenario("hall", 1), options);
    const int first = static_cast<int>(std::lround(part.start_s * options.rate_hz));
    VisualOdometry odometry{VisualOdometry::Config{}};
    Eigen::Isometry3d T_first_now = Eigen::Isometry3d::Identity();
    for (int i = first; i < first + pairs; ++i) {
      const auto result = odometry.process(simulator.render(i, false).pair, simulator.camera());
      if (i == first) continue;
      ASSERT_TRUE(result.hasMotion()) << i << ": " << result.reason;
      T_first_now = T_first_now * result.T_prev_cur;
    }
    const Eigen::Isometry3d truth =
        simulator.pose(first).inverse() * simulator.pose(first + pairs - 1);
    const Eigen::Isometry3d error = truth.inverse() * T_first_now;
    const Limits& limits = worn ? part.worn : part.perfect;
    EXPECT_LT(1e3 * error.translation().norm(), limits.mm) << (worn ? "worn" : "perfect");
    EXPECT_LT(1e3 * Eigen::AngleAxisd(error.linear()).angle(), limits.mrad)
        << (worn ? "worn" : "perfect");
  }
}

INSTANTIATE_TEST_SUITE_P(Hall,
                         PlaceAccuracyTest,
                         ::testing::Values(
                             // At 100 deg/s.
                             Part{"Turn", 9.9, {2.1, 0.4}, {54.0, 9.0}},
                             Part{"Wall", 17.9, {1.7, 0.3}, {22.0, 0.8}}),
                         [](const auto& part) { return part.param.name; });

}  // namespace
}  // namespace rotrocc
