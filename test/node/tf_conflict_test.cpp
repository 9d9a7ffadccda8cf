#include "node/tf_conflict.h"

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

std::string describe(const std::string& parent,
                     const std::string& child,
                     const std::string& publisher) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  return describeConflict(transform, publisher, "/odometry", "odom", "base_link");
}

TEST(TfConflictTest, OthersMayNotGiveTheBaseAParent) {
  EXPECT_EQ(describe("odom", "base_link", "/ekf").find("node /ekf publishes tf odom -> base_link"),
            0u);
  EXPECT_EQ(
      describe("/wheel_odom", "/base_link", "/base")
          .find("node /base publishes tf wheel_odom -> base_link, and this node publishes odom"),
      0u);
}

TEST(TfConflictTest, NeighboursInOurManagerAreToldByTheirParent) {
  EXPECT_NE(describe("wheel_odom", "base_link", "/odometry"), "");
}

TEST(TfConflictTest, OurOwnAndOtherFramesAreFine) {
  EXPECT_EQ(describe("odom", "base_link", "/odometry"), "");
  EXPECT_EQ(describe("base_link", "camera", "/robot_state_publisher"), "");
  EXPECT_EQ(describe("map", "odom", "/amcl"), "");
}

}  // namespace
}  // namespace rotrocc
