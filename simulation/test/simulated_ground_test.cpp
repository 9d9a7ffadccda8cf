// The ground of simulated drives along recorded poses, which may revisit a place at another height.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "simulation/drives/scenario.h"
#include "simulation/rendering/renderer.h"
#include "simulation/simulator.h"
#include "support/small_camera.h"

namespace rotrocc {
namespace {

/// A figure of eight that returns to its start, over a hill; each round ends `drop_m` lower than it
/// starts.
Trajectory figureOfEight(double drop_m) {
  Trajectory trajectory;
  for (int i = 0; i <= 500; ++i) {
    const double angle = 2.0 * M_PI * i / 400.0;  // 1 1/4 rounds
    StampedPose pose;
    pose.stamp_ns = i * 100'000'000LL;
    pose.T_world_body.translation() << 60.0 * std::sin(angle),
        2.0 * std::cos(2.0 * angle) + drop_m * i / 400.0, 45.0 * std::sin(2.0 * angle);
    const double dx = 60.0 * std::cos(angle);
    const double dz = 90.0 * std::cos(2.0 * angle);
    pose.T_world_body.rotate(Eigen::AngleAxisd(std::atan2(dx, dz), Eigen::Vector3d::UnitY()));
    trajectory.push_back(pose);
  }
  return trajectory;
}

TEST(SimulatedGround, NothingStandsOnARoadThatCrossesItself) {
  const Trajectory trajectory = figureOfEight(0.0);
  const World world(scenarioAlong(trajectory, 1).world);
  EXPECT_GT(world.bodies().size(), 200u);
  for (const StampedPose& pose : trajectory) {
    Eigen::Vector3d at = pose.T_world_body.translation();
    at.y() = world.terrain().height(at.x(), at.z());
    for (const Body& body : world.bodies()) {
      if (body.ownBounds().max().y() - body.ownBounds().min().y() < 0.5) continue;  // kerbs
      const Eigen::Vector3d own = body.toBody(at);
      const Eigen::AlignedBox3d& box = body.ownBounds();
      const double x = std::max(box.min().x() - own.x(), own.x() - box.max().x());
      const double z = std::max(box.min().z() - own.z(), own.z() - box.max().z());
      EXPECT_GT(std::max(x, z), 0.9) << "a car is 1.8 m wide";
    }
  }
}

/// Similar to the height error of the ground truth of KITTI 08 at revisited places.
constexpr double kDrop_m = 6.0;

TEST(SimulatedGround, GroundServesEveryVisitOfAPlace) {
  for (const double drop_m : {0.0, kDrop_m, -kDrop_m}) {
    const Scenario scenario = scenarioAlong(figureOfEight(drop_m), 1);
    World world(scenario.world);
    const double at_start = world.terrain().height(0.0, 0.0);
    for (int i = 0; i <= 500; ++i) {
      world.goTo(scenario.drive->station_m(0.1 * i));
      const Eigen::Vector3d at = scenario.drive->pose(0.1 * i).translation();
      // Cells of 8 m only approximate the hill.
      EXPECT_NEAR(world.terrain().height(at.x(), at.z()) - at.y(), 1.65, 0.25) << "frame " << i;
    }
    EXPECT_NEAR(world.terrain().height(0.0, 0.0) - at_start, drop_m, 0.5);
  }
}

TEST(SimulatedGround, BodiesStayOnTheGroundThatChanges) {
  const Scenario scenario = scenarioAlong(figureOfEight(kDrop_m), 1);
  World world(scenario.world);
  const std::vector<Body> before = world.bodies();
  const Terrain ground_before = world.terrain();
  world.goTo(scenario.drive->station_m(50.0));
  int moved = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Eigen::Vector3d was = before[i].T_world_body().translation();
    const Eigen::Vector3d is = world.bodies()[i].T_world_body().translation();
    EXPECT_NEAR(is.y() - world.terrain().height(is.x(), is.z()),
                was.y() - ground_before.height(was.x(), was.z()),
                1e-9);
    moved += (is - was).norm() > 1.0 ? 1 : 0;
  }
  EXPECT_GT(moved, 100);
}

/// Heights of points all over the ground.
std::vector<double> survey(const World& world) {
  std::vector<double> heights;
  for (double x = -150.0; x < 150.0; x += 4.0) {
    for (double z = -150.0; z < 150.0; z += 4.0) heights.push_back(world.terrain().height(x, z));
  }
  return heights;
}

/// The frames before and after each change must look the same with the old and the new ground.
TEST(SimulatedGround, GroundChangesOnlyOutOfSight) {
  const Scenario scenario = scenarioAlong(figureOfEight(kDrop_m), 1);
  const StereoCamera camera = smallCamera();
  const auto station = [&](int frame) { return scenario.drive->station_m(0.1 * frame); };
  World world(scenario.world);
  const auto depthOf = [&](int frame, int frame_of_world) {
    world.goTo(station(frame_of_world));
    return render(world, {}, {camera, {}}, scenario.drive->pose(0.1 * frame)).depth;
  };
  world.goTo(station(0));
  int changes = 0;
  for (int i = 0; i < 500; ++i) {
    const std::vector<double> before = survey(world);
    world.goTo(station(i + 1));
    if (survey(world) == before) continue;
    ++changes;
    for (const int frame : {i, i + 1}) {
      const cv::Mat then = depthOf(frame, i);
      const cv::Mat now = depthOf(frame, i + 1);
      EXPECT_EQ(cv::countNonZero(cv::abs(1.0 / then - 1.0 / now) > 1e-9), 0) << "frame " << frame;
    }
  }
  EXPECT_GT(changes, 5);
}

TEST(SimulatedGround, PosesOfARecordedDriveAreKept) {
  const Trajectory trajectory = figureOfEight(0.0);
  const Simulator simulator(scenarioAlong(trajectory, 1), SimulationOptions{});
  const Eigen::Isometry3d T_first_world = trajectory.front().T_world_body.inverse();
  for (const int i : {0, 7, 320}) {
    EXPECT_EQ(simulator.stamp_ns(i), trajectory[i].stamp_ns);
    EXPECT_TRUE(simulator.pose(i).isApprox(T_first_world * trajectory[i].T_world_body, 1e-9)) << i;
  }
}

}  // namespace
}  // namespace rotrocc
