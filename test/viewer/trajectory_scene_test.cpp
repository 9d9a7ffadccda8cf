#include "viewer/trajectory_scene.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>
#include <visualization_msgs/Marker.h>

namespace rotrocc {
namespace {

constexpr double kLeastSize_m = 10.0;

class TrajectorySceneTest : public ::testing::Test {
 protected:
  void setState(std::uint8_t state, const std::string& reason = "", double time_s = 1000.0) {
    OdometryStatus status;
    status.header.stamp = ros::Time(time_s);
    status.state = state;
    status.reason = reason;
    scene_.setState(status);
  }

  void addAt(double x_m, double time_s, const std::string& frame = "odom") {
    nav_msgs::Odometry odometry;
    odometry.header.frame_id = frame;
    odometry.header.stamp = ros::Time(time_s);
    odometry.pose.pose.position.x = x_m;
    odometry.pose.pose.orientation.w = 1.0;
    odometry.twist.twist.linear.x = 2.5;
    scene_.add(odometry);
  }

  visualization_msgs::Marker marker(const std::string& name) const {
    for (const visualization_msgs::Marker& marker : scene_.markers().markers) {
      if (marker.ns == name) return marker;
    }
    return {};
  }

  TrajectoryScene scene_{kLeastSize_m, "view"};
};

TEST_F(TrajectorySceneTest, SaysStateSpeedAndLength) {
  setState(OdometryStatus::OK);
  addAt(0.0, 1.0);
  addAt(3.0, 2.0);
  EXPECT_EQ(marker("state").text, "OK,  2.5 m/s,  3.0 m");
  setState(OdometryStatus::LOST, "12 features");
  EXPECT_EQ(marker("state").text, "LOST,  3.0 m\n12 features");
  setState(OdometryStatus::NO_INPUT, "the replay has ended");
  EXPECT_EQ(marker("state").text, "NO_INPUT,  3.0 m\nthe replay has ended");
}

TEST_F(TrajectorySceneTest, TheStatusOfAPoseMayComeAfterIt) {
  const std::uint8_t states[] = {
      OdometryStatus::OK, OdometryStatus::LOST, OdometryStatus::LOST, OdometryStatus::OK};
  for (const double step_m : {0.0, 1.0}) {
    scene_ = TrajectoryScene(kLeastSize_m, "view");
    for (int i = 0; i < 4; ++i) {
      addAt(step_m * i, i);
      setState(states[i], "", i);
    }
    const visualization_msgs::Marker way = marker("estimate");
    std::vector<bool> lost;
    for (const auto& color : way.colors) lost.push_back(color.r == 0.0f);
    if (step_m > 0.0) {
      EXPECT_EQ(lost, (std::vector<bool>{false, true, true, false, false}));
    } else {
      EXPECT_EQ(lost, (std::vector<bool>{false, true, false, false}));
    }
  }
}

/// while_lost: silent, or unknown.
TEST_F(TrajectorySceneTest, AWayWithoutPosesIsThatOfTheLoss) {
  addAt(0.0, 1.0);
  setState(OdometryStatus::OK, "", 1.0);
  for (const double time_s : {2.0, 3.0}) {
    setState(OdometryStatus::LOST, "", time_s);
    nav_msgs::Odometry unknown;
    unknown.header.frame_id = "odom";
    unknown.header.stamp = ros::Time(time_s);
    unknown.pose.covariance.fill(9999.0);
    unknown.pose.pose.position.x = -50.0;
    scene_.add(unknown);
  }
  addAt(5.0, 4.0);
  setState(OdometryStatus::OK, "", 4.0);
  const visualization_msgs::Marker way = marker("estimate");
  ASSERT_EQ(way.points.size(), 4u);
  EXPECT_EQ(way.points[1].x, 0.0);
  EXPECT_EQ(way.colors[1].r, 0.0f);
  EXPECT_EQ(way.points[2].x, 5.0);
  EXPECT_NE(way.colors[2].r, 0.0f);
}

TEST_F(TrajectorySceneTest, GrowsWithTheWay) {
  addAt(0.0, 0.0);
  const double height_m = scene_.view().transform.translation.z;
  const double width_m = marker("estimate").scale.x;
  EXPECT_GT(height_m, 0.5 * kLeastSize_m);
  for (int i = 1; i <= 1000; ++i) addAt(i, i);
  EXPECT_GT(scene_.view().transform.translation.z, 20.0 * height_m);
  EXPECT_GT(marker("estimate").scale.x, 20.0 * width_m);
  EXPECT_EQ(scene_.view().header.frame_id, "odom");
  EXPECT_EQ(scene_.view().child_frame_id, marker("state").header.frame_id);
}

TEST_F(TrajectorySceneTest, KeepsNoMorePointsThanAreSeen) {
  for (int i = 0; i < 100000; ++i) addAt(i % 1000, i);
  std::size_t points = 0;
  for (const visualization_msgs::Marker& marker : scene_.markers().markers) {
    if (marker.ns == "estimate") points += marker.points.size();
  }
  EXPECT_LT(points, 20200u);
  EXPECT_EQ(scene_.markers().markers.back().points.back().x, 999.0);
}

TEST_F(TrajectorySceneTest, RestartsAfterAJumpBackOrInAnotherFrame) {
  for (int i = 0; i < 100; ++i) addAt(i, i);
  addAt(500.0, 0.0);
  EXPECT_EQ(marker("estimate").points.size(), 2u);
  EXPECT_EQ(marker("start").pose.position.x, 500.0);
  addAt(501.0, 1.0);
  addAt(7.0, 2.0, "map");
  EXPECT_EQ(marker("start").pose.position.x, 7.0);
}

/// rviz sees 22.5 deg up and down; a picture that is as high as wide is its narrowest.
TEST(TrajectorySceneViewTest, WaysOfAnySizeFillThePicture) {
  const double edge = std::tan(M_PI / 8.0);
  for (const double size_m : {0.5, 50.0, 5000.0}) {
    std::vector<Eigen::Vector3d> ahead, aside, around;
    for (int i = 0; i <= 60; ++i) {
      const double angle = i * M_PI / 30.0;
      ahead.emplace_back(i * size_m / 60.0, 0.0, 0.0);
      aside.emplace_back(0.0, size_m * (1.0 + i / 60.0), 0.0);
      around.emplace_back(
          size_m * std::sin(angle), size_m * (1.0 - std::cos(angle)), 0.02 * i * size_m);
    }
    for (const auto& points : {ahead, aside, around}) {
      TrajectoryScene scene(0.0, "view");
      nav_msgs::Odometry odometry;
      for (const Eigen::Vector3d& point : points) {
        odometry.pose.pose.position = tf2::toMsg(point);
        scene.add(odometry);
      }
      const Eigen::Isometry3d T_view_odom = tf2::transformToEigen(scene.view()).inverse();
      double side = 0.0, top = -1.0, bottom = 1.0;  // of the picture, as tangents
      for (const Eigen::Vector3d& point : points) {
        const Eigen::Vector3d p = T_view_odom * point;
        EXPECT_GT(p.x(), 0.0) << "behind the camera";
        side = std::max(side, std::abs(p.y() / p.x()));
        top = std::max(top, p.z() / p.x());
        bottom = std::min(bottom, p.z() / p.x());
      }
      EXPECT_LE(side, 0.42 + 1e-9);
      EXPECT_LE(top, edge);
      EXPECT_GE(bottom, -edge);
      // The nearest such place: the points reach both sides, or top and bottom.
      EXPECT_TRUE(side > 0.41 || top - bottom > 0.60) << side << ", " << top - bottom;
    }
  }
}

TEST_F(TrajectorySceneTest, ShowsTheTruthIfThereIsOne) {
  EXPECT_TRUE(scene_.markers().markers.empty()) << "without a pose";
  addAt(0.0, 0.0);
  EXPECT_EQ(marker("truth").ns, "");
  nav_msgs::Path truth;
  truth.header.frame_id = "odom";
  truth.poses.resize(2);
  truth.poses[1].pose.position.x = 4.0;
  scene_.setTruth(truth);
  EXPECT_EQ(marker("truth").points.size(), 2u);
  EXPECT_GT(marker("truth").scale.x, marker("estimate").scale.x);
}

}  // namespace
}  // namespace rotrocc
