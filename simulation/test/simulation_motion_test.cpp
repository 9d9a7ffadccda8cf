// How the scenarios move, without rendering: speeds, turn rates, smoothness.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "simulation/drives/scenario.h"
#include "support/expect_error.h"

namespace rotrocc {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kStep_s = 0.01;

double speed(const Drive& drive, double time_s) {
  return (drive.pose(time_s + kStep_s).translation() - drive.pose(time_s).translation()).norm() /
         kStep_s;
}

double turnRate(const Drive& drive, double time_s) {
  const Eigen::Matrix3d turned =
      drive.pose(time_s).linear().transpose() * drive.pose(time_s + kStep_s).linear();
  return Eigen::AngleAxisd(turned).angle() / kStep_s;
}

template <typename Quantity>
double greatest(const Drive& drive, const Quantity& quantity) {
  double most = 0.0;
  for (double t = 0.0; t < drive.duration_s() - kStep_s; t += 0.05) {
    most = std::max(most, quantity(drive, t));
  }
  return most;
}

double standing(const Drive& drive) {
  double time_s = 0.0;
  for (double t = 0.0; t < drive.duration_s() - kStep_s; t += 0.05) {
    if (speed(drive, t) < 1e-6) time_s += 0.05;
  }
  return time_s;
}

TEST(SimulationMotion, CityIs300MetresWithTwoTurnsAndAStop) {
  const Scenario city = scenario("city", 1);
  EXPECT_NEAR(city.drive->station_m(city.drive->duration_s()), 300.0, 5.0);
  EXPECT_GT(standing(*city.drive), 2.0);
  EXPECT_GT(greatest(*city.drive, turnRate), 20.0 * kDegree);
  EXPECT_LT(greatest(*city.drive, speed), 11.0);
}

TEST(SimulationMotion, MotorwayHas25MetresPerSecond) {
  const Scenario motorway = scenario("motorway", 1);
  for (double t = 0.0; t < motorway.drive->duration_s(); t += 1.0) {
    EXPECT_NEAR(speed(*motorway.drive, t), 25.0, 0.2) << "at " << t << " s";  // bumps add a little
  }
}

TEST(SimulationMotion, SlipRoadTurnsWith26DegreesPerSecondAt10MetresPerSecond) {
  const Scenario ramp = scenario("slip_road", 1);
  double longest_s = 0.0;
  for (double t = 0.0; t < ramp.drive->duration_s() - kStep_s; t += 0.1) {
    EXPECT_NEAR(speed(*ramp.drive, t), 10.0, 0.1) << "at " << t << " s";
    if (std::abs(turnRate(*ramp.drive, t) - 26.0 * kDegree) < 1.5 * kDegree) longest_s += 0.1;
  }
  EXPECT_GT(longest_s, 5.0);
}

TEST(SimulationMotion, ParkingIsSlowAndStandsWhileACarPasses) {
  const Scenario parking = scenario("parking", 1);
  EXPECT_LT(greatest(*parking.drive, speed), 1.0);
  EXPECT_GT(standing(*parking.drive), 5.0);
  ASSERT_FALSE(parking.traffic.meetings_s.empty());
  EXPECT_LT(speed(*parking.drive, parking.traffic.meetings_s.front()), 1e-6);
}

TEST(SimulationMotion, ShakePitchesAndRolls) {
  const Scenario shake = scenario("shake", 1);
  EXPECT_GT(greatest(*shake.drive, turnRate), 15.0 * kDegree);
  EXPECT_NEAR(speed(*shake.drive, 5.0), 8.0, 0.2);
}

TEST(SimulationMotion, HandheldLooksAroundFast) {
  const Scenario handheld = scenario("handheld", 1);
  EXPECT_NEAR(speed(*handheld.drive, 5.0), 1.4, 0.2);
  EXPECT_GT(greatest(*handheld.drive, turnRate), 100.0 * kDegree);
  EXPECT_LT(greatest(*handheld.drive, turnRate), 180.0 * kDegree);
}

TEST(SimulationMotion, AccelerationIsContinuousInEveryScenario) {
  for (const std::string& name : scenarioNames()) {
    const Scenario scene = scenario(name, 1);
    const auto acceleration = [&](double t) -> Eigen::Vector3d {
      const auto at = [&](double time_s) -> Eigen::Vector3d {
        return scene.drive->pose(time_s).translation();
      };
      return (at(t + kStep_s) - 2.0 * at(t) + at(t - kStep_s)) / (kStep_s * kStep_s);
    };
    for (double t = 0.1; t < scene.drive->duration_s() - 0.1; t += kStep_s) {
      // A jump of 1 m/s^2 within 10 ms would be a jerk of 100 m/s^3, ten times that of a hard stop.
      ASSERT_LT((acceleration(t + kStep_s) - acceleration(t)).norm(), 1.0) << name << " at " << t;
    }
  }
}

TEST(SimulationMotion, RecordedDriveGoesThroughItsPoses) {
  Trajectory trajectory;
  for (int i = 0; i < 40; ++i) {
    StampedPose pose;
    pose.stamp_ns = 5'000'000'000 + i * 100'000'000LL;
    pose.T_world_body.translate(Eigen::Vector3d(std::sin(0.1 * i), 0.02 * i, 1.1 * i));
    pose.T_world_body.rotate(Eigen::AngleAxisd(0.03 * i, Eigen::Vector3d::UnitY()));
    trajectory.push_back(pose);
  }
  const RecordedDrive drive(trajectory);
  for (int i = 0; i < 40; ++i) {
    EXPECT_TRUE(drive.pose(0.1 * i).isApprox(trajectory[i].T_world_body, 1e-9)) << i;
  }
  EXPECT_NEAR(drive.duration_s(), 3.9, 1e-9);
}

TEST(SimulationMotion, RecordedDriveTurnsSmoothly) {
  Trajectory trajectory;
  for (int i = 0; i < 20; ++i) {
    StampedPose pose;
    pose.stamp_ns = i * 100'000'000LL;
    pose.T_world_body.translate(Eigen::Vector3d(0.0, 0.0, 1.1 * i));
    pose.T_world_body.rotate(Eigen::AngleAxisd(0.4 * std::sin(0.6 * i), Eigen::Vector3d::UnitY()));
    pose.T_world_body.rotate(Eigen::AngleAxisd(0.2 * std::cos(0.5 * i), Eigen::Vector3d::UnitX()));
    trajectory.push_back(pose);
  }
  const RecordedDrive drive(trajectory);
  constexpr double kShort_s = 1e-4;
  for (int i = 1; i < 19; ++i) {
    const auto rotation = [&](double from_s, double to_s) {
      return Eigen::AngleAxisd(drive.pose(from_s).linear().transpose() * drive.pose(to_s).linear())
                 .angle() /
             (to_s - from_s);
    };
    const double t = 0.1 * i;
    // The rate changes by up to 14 rad/s^2 here, and by 1 rad/s at once between straight pieces.
    EXPECT_NEAR(rotation(t - kShort_s, t), rotation(t, t + kShort_s), 0.01) << i;
  }
}

TEST(SimulationMotion, RecordedDriveGoesOnBeyondItsEnds) {
  const auto poseAt = [](double time_s) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(Eigen::Vector3d(0.0, 0.0, 11.0 * time_s));
    pose.rotate(Eigen::AngleAxisd(0.7 * time_s, Eigen::Vector3d::UnitY()));
    return pose;
  };
  Trajectory trajectory;
  for (int i = 0; i <= 10; ++i) trajectory.push_back({i * 100'000'000LL, poseAt(0.1 * i)});
  const RecordedDrive drive(trajectory);
  for (const double time_s : {-0.05, 1.05}) {
    EXPECT_TRUE(drive.pose(time_s).isApprox(poseAt(time_s), 1e-9)) << time_s;
  }
}

TEST(SimulationMotion, RefusesWhatIsNoDrive) {
  expectError<std::invalid_argument>([] { scenario("town", 1); }, "there is no scenario 'town'");
  Trajectory standing(5);
  for (int i = 0; i < 5; ++i) standing[i].stamp_ns = i;
  expectError<std::invalid_argument>([&] { RecordedDrive drive(standing); }, "stay within 1 cm");
}

}  // namespace
}  // namespace rotrocc
