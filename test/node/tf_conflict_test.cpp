#include "node/tf/tf_conflict.h"

#include <gtest/gtest.h>

#include "node/node_parameters.h"

namespace rotrocc {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

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
  EXPECT_EQ(describe(own, "/amcl", "map"),
            "/amcl publishes tf map -> odom, and /odometry publishes visual_odom -> odom, but a "
            "frame has only one parent: set publish_tf to false in one of them");
}

TEST(TfConflictTest, KnowsWhatIsPublished) {
  NodeParameters parameters;
  EXPECT_EQ(publishedTf("/odometry", parameters).child, "base_link");
  parameters.invert_tf = true;
  EXPECT_EQ(publishedTf("/odometry", parameters).parent, "base_link");
  EXPECT_EQ(publishedTf("/odometry", parameters).child, "odom");
}

TEST(RecentConflictsTest, ConflictsInTurnAreNewOnce) {
  RecentConflicts conflicts;
  RecentConflicts::Time now{};
  int found = 0;
  for (int i = 0; i < 100; ++i, now += milliseconds(50)) {
    found += conflicts.add(i % 2 == 0 ? "/ekf" : "/wheels", false, now);
    EXPECT_EQ(conflicts.first(now), "/ekf");
  }
  EXPECT_EQ(found, 2);
}

TEST(RecentConflictsTest, AreGoneAfterSomeSecondsUnlessStatic) {
  const RecentConflicts::Time start{};
  RecentConflicts conflicts;
  EXPECT_TRUE(conflicts.add("/ekf", false, start));
  EXPECT_FALSE(conflicts.add("/ekf", false, start + seconds(2))) << "may be slow";
  EXPECT_EQ(conflicts.first(start + seconds(4)), "/ekf");
  EXPECT_EQ(conflicts.first(start + seconds(10)), "");
  EXPECT_TRUE(conflicts.add("/ekf", false, start + seconds(10))) << "is back";
  EXPECT_TRUE(conflicts.add("/static", true, start));
  EXPECT_EQ(conflicts.first(start + std::chrono::hours(1)), "/static");
  EXPECT_FALSE(conflicts.add("/static", true, start + std::chrono::hours(1)));
}

}  // namespace
}  // namespace rotrocc
