// Beside another odometry: guess_frame, if that owns the base in tf, or guess_topic.

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>

#include <nav_msgs/Odometry.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

#include "input/message_conversion.h"
#include "node/odometry_messages.h"
#include "nodelet_drive.h"

namespace rotrocc {
namespace {

geometry_msgs::TransformStamped wheelOdometry(const ros::Time& stamp,
                                              double x_m,
                                              double y_m = 0.0) {
  const Eigen::Isometry3d T_wheels_base(Eigen::Translation3d(x_m, y_m, 0.0));
  return toTransform(T_wheels_base, toNanoseconds(stamp), "wheel_odom", "base_link");
}

TEST(GuessFrameTest, IfItIsMissingThatIsToldCountedAndTriedAgain) {
  DiagnosticsListener diagnostics;
  NodeletDrive drive({{"guess_frame", "wheel_odom"}});
  drive.setUp();
  const std::string told = "no pose from guess_frame wheel_odom";
  OdometryStatus status;
  for (int pair = 0; pair < 10; ++pair) status = drive.statusOf(drive.robot.drive());
  EXPECT_EQ(status.state, OdometryStatus::OK) << status.reason;
  ASSERT_EQ(status.hint.find(told), 0u) << status.hint;
  EXPECT_EQ(status.guess_misses, 9u) << "all but the first pair";
  EXPECT_TRUE(diagnostics.says("stereo_odometry: tf", told));

  tf2_ros::TransformBroadcaster wheels;
  double way_m = 0.0;
  EXPECT_TRUE(waitUntil([&] {
    const auto [left, right] = drive.robot.see();
    wheels.sendTransform(wheelOdometry(left.header.stamp, way_m += SimulatedRobot::kStep_m));
    drive.robot.publish(left, right);
    status = drive.statusOf(left.header.stamp);
    return status.hint.empty();
  }));
  EXPECT_GE(status.guess_misses, 9u);
  EXPECT_TRUE(diagnostics.says("stereo_odometry: tf", "no conflict"));
}

/// Sends the pose of the base by the wheels.
using SendWheels = std::function<void(const ros::Time& stamp, double way_m)>;

/// The images are away for longer than tf2 remembers, while the wheels go on.
void expectMovesThroughALongGap(NodeletDrive& drive, const SendWheels& send) {
  drive.setUp();
  double way_m = 0.0;
  const auto see = [&] {
    const auto images = drive.robot.see();
    way_m += SimulatedRobot::kStep_m;
    send(images.first.header.stamp, way_m);
    return images;
  };
  double start_m = 0.0, found_m = 0.0;
  EXPECT_TRUE(waitUntil([&] {  // the wheels are connected
    const auto [left, right] = see();
    drive.robot.publish(left, right);
    const bool misses = drive.statusOf(left.header.stamp).guess_misses > 0;
    found_m = drive.odometryOf(left.header.stamp).pose.pose.position.x;
    start_m = way_m;
    return !misses && found_m > 0.0;
  }));
  for (int i = 0; i < 120; ++i) see();
  ros::Time stamp;
  for (int i = 0; i < 2; ++i) {  // a stamp far ahead is used when the next one follows it
    const auto [left, right] = see();
    stamp = left.header.stamp;
    // On a busy machine tf takes longer than the node waits for it.
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    drive.robot.publish(left, right);
  }
  const double after_m = drive.odometryOf(stamp).pose.pose.position.x;
  EXPECT_NEAR(after_m - found_m, way_m - start_m, 0.05) << "one of the pairs was seen";
}

TEST(GuessFrameTest, TheBaseMovesByItThroughALongGap) {
  NodeletDrive drive({{"guess_frame", "wheel_odom"}});
  tf2_ros::TransformBroadcaster wheels;
  expectMovesThroughALongGap(drive, [&](const ros::Time& stamp, double way_m) {
    wheels.sendTransform(wheelOdometry(stamp, way_m));
  });
}

/// An odometry that sends no tf; tf is that of the camera's odometry alone.
TEST(GuessTopicTest, TheBaseMovesByItThroughALongGap) {
  NodeletDrive drive({{"guess_topic", "wheels"}});
  ros::Publisher wheels = ros::NodeHandle().advertise<nav_msgs::Odometry>("wheels", 200);
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  ros::Time last;
  expectMovesThroughALongGap(drive, [&](const ros::Time& stamp, double way_m) {
    nav_msgs::Odometry message;
    message.header.stamp = last = stamp;
    message.header.frame_id = "odom";
    message.child_frame_id = "base_link";
    message.pose.pose.position.x = way_m;
    message.pose.pose.orientation.w = 1.0;
    wheels.publish(message);
  });
  EXPECT_TRUE(buffer.canTransform("odom", "base_link", last, ros::Duration(5.0)));
}

TEST(GuessTopicTest, OfAnotherBodyIsNotUsedAndThatIsReported) {
  NodeletDrive drive({{"guess_topic", "wheels"}});
  ros::Publisher wheels = ros::NodeHandle().advertise<nav_msgs::Odometry>("wheels", 1, true);
  nav_msgs::Odometry message;
  message.child_frame_id = "base_footprint";
  message.pose.pose.orientation.w = 1.0;
  wheels.publish(message);
  drive.setUp();
  OdometryStatus status;
  EXPECT_TRUE(waitUntil([&] {
    status = drive.statusOf(drive.robot.drive());
    return status.hint.find(
               "no pose from guess_topic wheels: it has the motion of base_footprint") == 0u;
  })) << status.hint;
}

TEST(GuessTopicTest, TheOwnOutputIsRejected) {
  EXPECT_THROW(NodeletDrive({{"guess_topic", "odom"}}), std::invalid_argument);
}

TEST(GuessFrameTest, BaseHasOneParentOnly) {
  const RunningNodelet inverted({{"invert_tf", true}},
                                "/inverted",
                                {{"odom", "inverted_odom"}, {"status", "inverted_status"}});
  NodeletDrive drive({{"odom_frame", "visual_odom"}, {"guess_frame", "wheel_odom"}});
  Received<nav_msgs::Odometry> inverted_odometry("inverted_odom");
  double inverted_way_m = 0.0;
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  tf2_ros::TransformBroadcaster wheels;
  drive.setUp();

  // If the tf of the wheels, which have a slip of 5 %, is late, the pair has no tf either.
  ros::Time first;
  double way_m = 0.0;
  nav_msgs::Odometry odometry;
  ASSERT_TRUE(waitUntil([&] {
    const auto [left, right] = drive.robot.see();
    const ros::Time stamp = left.header.stamp;
    if (first.isZero()) first = stamp;
    way_m = (stamp - first).toSec() / SimulatedRobot::kPeriod_s * SimulatedRobot::kStep_m;
    wheels.sendTransform(wheelOdometry(stamp, 1.05 * way_m, 7.0));
    drive.robot.publish(left, right);
    odometry = drive.odometryOf(stamp);
    const auto has_tf = [&](const char* target, const char* source) {
      return buffer.canTransform(target, source, stamp, ros::Duration(0.2));
    };
    const bool complete = has_tf("visual_odom", "base_link") && has_tf("base_link", "odom");
    const auto last = inverted_odometry.last();
    if (last) inverted_way_m = last->pose.pose.position.x;
    return complete && last && last->header.stamp == stamp && way_m > 1.9;
  }));
  EXPECT_NEAR(odometry.pose.pose.position.x, way_m, 0.02 + 0.02 * way_m);
  EXPECT_EQ(odometry.header.frame_id, "visual_odom");

  // The pose of the base in the visual frame is composed with that of the wheels.
  const ros::Time& stamp = odometry.header.stamp;
  const auto pose = buffer.lookupTransform("visual_odom", "base_link", stamp);
  EXPECT_NEAR(pose.transform.translation.x, odometry.pose.pose.position.x, 1e-9);
  EXPECT_NEAR(pose.transform.translation.y, odometry.pose.pose.position.y, 1e-9);
  // The other odometry publishes its own frame below the base.
  for (const auto& [child, expected] : std::map<std::string, std::string>{
           {"base_link", "wheel_odom"}, {"wheel_odom", "visual_odom"}, {"odom", "base_link"}}) {
    std::string parent;
    ASSERT_TRUE(buffer._getParent(child, stamp, parent));
    EXPECT_EQ(parent, expected);
  }
  const auto inverse = buffer.lookupTransform("base_link", "odom", stamp);
  EXPECT_GT(inverted_way_m, SimulatedRobot::kStep_m);
  EXPECT_NEAR(inverse.transform.translation.x, -inverted_way_m, 0.01 * inverted_way_m);
}

/// Pairs of a robot at rest that arrive at once, while each waits for the tf of its wheels, which
/// comes with every tenth pair.
TEST(GuessFrameTest, OfABurstTheNewestPairIsProcessedAndDropsAreCounted) {
  constexpr std::uint64_t kPairs = 101;
  NodeletDrive drive({{"guess_frame", "wheel_odom"}});
  tf2_ros::TransformBroadcaster wheels;
  drive.setUp();
  OdometryStatus status;
  for (int i = 0; i < 3; ++i) status = drive.statusOf(drive.robot.drive());
  const std::uint64_t processed_before = status.pairs_processed;
  auto [left, right] = drive.robot.see();
  for (std::uint64_t i = 0; i < kPairs; ++i) {
    left.header.stamp += ros::Duration(0.01);
    right.header.stamp = left.header.stamp;
    for (auto* image : {&left, &right}) {  // no pair is that of one before, nor at half its size
      for (std::size_t y = 0; y < 8; ++y) {
        std::fill_n(&image->data[y * image->step], 8, static_cast<unsigned char>(i));
      }
    }
    drive.robot.publish(left, right);
    drive.nodelet.finish();
    if (i % 10 == 0) wheels.sendTransform(wheelOdometry(left.header.stamp, 0.0));
  }
  status = drive.statusOf(left.header.stamp);
  EXPECT_EQ(status.state, OdometryStatus::OK) << status.reason;
  EXPECT_NEAR(drive.odometryOf(left.header.stamp).twist.twist.linear.x, 0.0, 0.2);
  ASSERT_EQ(status.drops.size(), 1u);
  EXPECT_EQ(status.drops[0].reason, "newer_pair_came");
  EXPECT_GT(status.drops[0].count, 0U) << "how many depends on the load";
  EXPECT_EQ(status.pairs_processed - processed_before + status.drops[0].count, kPairs);
}

}  // namespace
}  // namespace rotrocc
