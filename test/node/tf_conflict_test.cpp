#include "node/tf/tf_conflict.h"

#include <gtest/gtest.h>

#include "node/node_parameters.h"

namespace rotrocc {
namespace {

const PublishedTf kOwn = {"/odometry", "odom", "base_link"};

std::string describe(const PublishedTf& own, const std::string& rival, const std::string& parent) {
  return describeConflict(own, {rival, parent, own.child}, "base_link");
}

TEST(TfConflictTest, OthersMayNotGiveTheBaseAParent) {
  EXPECT_EQ(describe(kOwn, "/ekf", "odom"),
            "/ekf publishes tf odom -> base_link as well: set publish_tf to false if that is a "
            "filter that uses this odometry, or odom_frame to visual_odom and guess_frame to odom "
            "if it is another odometry");
  EXPECT_EQ(describe(kOwn, "/wheels", "wheel_odom"),
            "/wheels publishes tf wheel_odom -> base_link, and /odometry publishes odom -> "
            "base_link, but a frame has only one parent: set publish_tf to false if that is a "
            "filter that uses this odometry, or guess_frame to wheel_odom if it is another "
            "odometry");
}

TEST(TfConflictTest, AdviceIsAccepted) {
  NodeParameters parameters;
  parameters.guess_frame = "wheel_odom";
  EXPECT_NO_THROW(requireFrames(parameters));
  parameters.odom_frame = "visual_odom";
  parameters.guess_frame = "odom";
  EXPECT_NO_THROW(requireFrames(parameters));
  // With it, the base has one parent, and its odom frame has one.
  const PublishedTf own = publishedTf("/odometry", parameters);
  EXPECT_EQ(own.parent, "visual_odom");
  EXPECT_EQ(own.child, "odom");
  EXPECT_EQ(
      describe(own, "/amcl", "map"),
      "/amcl publishes tf map -> odom, and /odometry publishes visual_odom -> odom, but a "
      "frame has only one parent: if that is a localization, set its odom frame to "
      "visual_odom (odom_frame_id of amcl); otherwise set publish_tf to false in one of them");
  // The other way round, base_link is the parent.
  EXPECT_EQ(describe({"/odometry", "base_link", "odom"}, "/amcl", "map"),
            "/amcl publishes tf map -> odom, and /odometry publishes base_link -> odom, but a "
            "frame has only one parent: set publish_tf to false in one of them");
}

}  // namespace
}  // namespace rotrocc
