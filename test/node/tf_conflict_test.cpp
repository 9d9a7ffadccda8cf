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

TEST(TfRivalsTest, RivalsInTurnAreNewOnce) {
  TfRivals rivals;
  TfRivals::Time now{};
  int found = 0;
  for (int i = 0; i < 100; ++i, now += milliseconds(50)) {
    found += rivals.add({i % 2 == 0 ? "/ekf" : "/wheels", "odom", "base_link"}, false, now);
    EXPECT_EQ(rivals.present(now).front().node, "/ekf");
  }
  EXPECT_EQ(found, 2);
}

TEST(TfRivalsTest, AreGoneAfterSomeSeconds) {
  const PublishedTf rival = {"/ekf", "odom", "base_link"};
  const TfRivals::Time start{};
  TfRivals rivals;
  EXPECT_TRUE(rivals.add(rival, false, start));
  EXPECT_FALSE(rivals.add(rival, false, start + seconds(2))) << "may be slow";
  EXPECT_FALSE(rivals.present(start + seconds(4)).empty());
  EXPECT_TRUE(rivals.present(start + seconds(10)).empty());
  EXPECT_TRUE(rivals.add(rival, false, start + seconds(10))) << "is back";
}

TEST(TfRivalsTest, StaticTransformsStay) {
  const PublishedTf rival = {"/static", "map", "base_link"};
  const TfRivals::Time start{};
  TfRivals rivals;
  EXPECT_TRUE(rivals.add(rival, true, start));
  EXPECT_FALSE(rivals.present(start + std::chrono::hours(1)).empty());
  EXPECT_FALSE(rivals.add(rival, true, start + std::chrono::hours(1)));
}

}  // namespace
}  // namespace rotrocc
