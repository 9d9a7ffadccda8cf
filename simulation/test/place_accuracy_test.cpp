// The whole pipeline on the hardest short parts of the places beside the streets.

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

StereoCamera camera(int width, int height, double focal_px, double baseline_m) {
  StereoCamera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = focal_px;
  camera.cx = camera.cx_right = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  camera.baseline_m = baseline_m;
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
  std::string scenario;
  StereoCamera camera;
  double rate_hz;
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
    options.camera = part.camera;
    options.rate_hz = part.rate_hz;
    options.worn_rig = worn;
    Simulator simulator(scenario(part.scenario, 1), options);
    const int first = static_cast<int>(std::lround(part.start_s * part.rate_hz));
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

StereoCamera indoorCamera() {
  return camera(752, 480, 460.0, 0.11);
}

StereoCamera helmetCamera() {
  return camera(400, 300, 250.0, 0.12);
}

StereoCamera carCamera() {
  return camera(620, 188, 360.0, 0.537);
}

INSTANTIATE_TEST_SUITE_P(
    Places,
    PlaceAccuracyTest,
    ::testing::Values(
        // At 100 deg/s.
        Part{"HallTurn", "hall", indoorCamera(), 20.0, 10.6, {18.5, 2.6}, {42.0, 9.7}},
        Part{"HallWall", "hall", indoorCamera(), 20.0, 19.4, {7.0, 1.3}, {20.2, 3.6}},
        Part{"WalkStair", "walk", helmetCamera(), 20.0, 13.0, {8.5, 4.1}, {9.4, 3.4}},
        Part{"WalkTurn", "walk", helmetCamera(), 20.0, 26.4, {10.6, 1.3}, {27.0, 7.3}},
        Part{"Tunnel", "tunnel", carCamera(), 10.0, 6.0, {126.0, 1.4}, {244.0, 1.8}}),
    [](const auto& part) { return part.param.name; });

}  // namespace
}  // namespace rotrocc
