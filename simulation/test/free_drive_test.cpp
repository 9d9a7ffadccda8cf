// Motions through waypoints, without rendering.

#include "simulation/drives/free_drive.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "rotrocc/rigid_motion.h"
#include "support/expect_error.h"

namespace rotrocc {
namespace {

std::vector<Waypoint> waypoints() {
  return {{0.0, {0.0, 0.0, 0.0}},
          {2.0, {1.0, -1.0, 2.0}, 0.5},
          {3.0, {1.0, -1.0, 2.0}, 0.5},  // rests
          {4.0, {1.0, -1.0, 2.0}, 2.0, 0.1},
          {6.0, {-2.0, 0.5, 3.0}, 3.0, -0.2, 0.3},
          {7.5, {-3.0, 0.5, 6.0}, 2.5, 0.0, 0.1}};
}

Carrier shaky() {
  Carrier carrier;
  carrier.lean = 1.0;
  carrier.drift_m = 0.02;
  carrier.drift_rad = 0.01;
  return carrier;
}

TEST(FreeDrive, PassesItsWaypoints) {
  const FreeDrive drive(waypoints(), {});
  for (const Waypoint& w : waypoints()) {
    Eigen::Isometry3d expected = Eigen::Isometry3d::Identity();
    expected.translation() = w.position;
    expected.rotate(Eigen::AngleAxisd(w.yaw_rad, Eigen::Vector3d::UnitY()));
    expected.rotate(Eigen::AngleAxisd(w.pitch_rad, Eigen::Vector3d::UnitX()));
    expected.rotate(Eigen::AngleAxisd(w.roll_rad, Eigen::Vector3d::UnitZ()));
    EXPECT_TRUE(drive.pose(w.time_s).isApprox(expected, 1e-9)) << w.time_s;
  }
  EXPECT_EQ(drive.duration_s(), 7.5);
}

TEST(FreeDrive, RestsBetweenEqualWaypointsAndNeverOvershoots) {
  const FreeDrive drive(waypoints(), {});
  for (double t = 2.0; t <= 3.0; t += 0.1) {
    EXPECT_TRUE(drive.pose(t).isApprox(drive.pose(2.0), 1e-12)) << t;
  }
  for (double t = 0.0; t < 2.0; t += 0.05) {
    const Eigen::Vector3d change = drive.pose(t + 0.05).translation() - drive.pose(t).translation();
    EXPECT_GE(change.z(), 0.0) << t;
    EXPECT_LE(change.y(), 0.0) << t;
  }
}

TEST(FreeDrive, TurnsAtAContinuousRate) {
  const FreeDrive drive(waypoints(), shaky());
  constexpr double kShort_s = 1e-4;
  const auto rate = [&](double t) -> Eigen::Vector3d {
    return logRotation(drive.pose(t).linear().transpose() * drive.pose(t + kShort_s).linear()) /
           kShort_s;
  };
  for (double t = 0.1; t < 7.4; t += 0.01) {
    // Up to 20 rad/s^2; a kink between two pieces would be a jump of 1 rad/s.
    EXPECT_LT((rate(t + kShort_s) - rate(t)).norm(), 0.005) << t;
  }
}

TEST(FreeDrive, LeansIntoItsAcceleration) {
  Carrier carrier;
  carrier.lean = 1.0;
  const FreeDrive drive({{0.0, {0.0, 0.0, 0.0}}, {3.0, {0.0, 0.0, 6.0}}}, carrier);
  // Positive forwards: z of the camera's axis that looks ahead points down while it speeds up.
  EXPECT_GT(drive.pose(0.7).linear()(1, 2), 0.2);
  EXPECT_LT(drive.pose(2.3).linear()(1, 2), -0.2);
  EXPECT_NEAR(drive.pose(1.5).linear()(1, 2), 0.0, 1e-3);
}

TEST(FreeDrive, BobsWithStepsOnly) {
  Carrier carrier;
  carrier.bob_m = 0.02;
  const FreeDrive drive({{0.0, {0.0, 0.0, 0.0}, 0.0, 0.0, 0.0, 0.0},
                         {4.0, {0.0, 0.0, 4.0}, 0.0, 0.0, 0.0, 6.0},
                         {5.0, {0.0, 0.0, 4.0}, 1.0, 0.0, 0.0, 6.0}},
                        carrier);
  double low = 0.0;
  double high = 0.0;
  for (double t = 0.0; t < 4.0; t += 0.01) {
    low = std::max(low, drive.pose(t).translation().y());
    high = std::min(high, drive.pose(t).translation().y());
  }
  EXPECT_NEAR(low, 0.02, 1e-3);
  EXPECT_NEAR(high, -0.02, 1e-3);
  EXPECT_NEAR((drive.pose(4.5).translation() - drive.pose(4.0).translation()).norm(), 0.0, 1e-12);
}

TEST(FreeDrive, DriftsWithItsSigmaAndBySeed) {
  Carrier carrier;
  carrier.drift_m = 0.02;
  carrier.still_s = 1.0;
  const std::vector<Waypoint> long_way = {{0.0, {0.0, 0.0, 0.0}}, {200.0, {0.0, 0.0, 2.0}}};
  const FreeDrive drive(long_way, carrier);
  EXPECT_EQ(drive.pose(0.9).translation().x(), 0.0);
  double squares = 0.0;
  int count = 0;
  for (double t = 2.0; t < 200.0; t += 0.1) {
    squares += drive.pose(t).translation().x() * drive.pose(t).translation().x();
    ++count;
  }
  EXPECT_NEAR(std::sqrt(squares / count), 0.02, 0.004);
  const FreeDrive again(long_way, carrier);
  carrier.seed = 2;
  const FreeDrive other(long_way, carrier);
  EXPECT_TRUE(drive.pose(7.0).matrix() == again.pose(7.0).matrix());
  EXPECT_FALSE(drive.pose(7.0).isApprox(other.pose(7.0), 1e-6));
}

TEST(FreeDrive, StationsCountTheWay) {
  const FreeDrive drive(waypoints(), {});
  EXPECT_EQ(drive.station_m(0.0), 0.0);
  EXPECT_NEAR(drive.station_m(2.5), std::sqrt(6.0), 0.05);
  EXPECT_EQ(drive.station_m(2.2), drive.station_m(2.9));
  EXPECT_GT(drive.station_m(7.0), drive.station_m(6.0));
}

TEST(FreeDrive, RefusesWhatIsNoMotion) {
  const auto expectRefused = [](const std::vector<Waypoint>& points, const std::string& part) {
    expectError<std::invalid_argument>([&] { FreeDrive drive(points, {}); }, part);
  };
  expectRefused({{0.0, {0.0, 0.0, 0.0}}}, "at least two");
  expectRefused({{0.0, {0.0, 0.0, 0.0}}, {0.0, {0.0, 0.0, 3.0}}}, "sort them by time");
  expectRefused({{0.0, {0.0, 0.0, 0.0}}, {1.0, {0.0, 0.0, 0.3}}}, "within 1 m");
}

}  // namespace
}  // namespace rotrocc
