// Two odometries in one process that publish the same tf, and rivals elsewhere.

#include <optional>

#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include "node/odometry_messages.h"
#include "nodelet_drive.h"

namespace rotrocc {
namespace {

geometry_msgs::TransformStamped parentOfBase(const std::string& parent) {
  return toTransform(Eigen::Isometry3d::Identity(), 0, parent, "base_link");
}

TEST(TfRivalsTest, NameEachOtherAndOthersUntilTheyAreGone) {
  DiagnosticsListener diagnostics;
  const LogRecorder log;
  const auto isLogged = [&](const std::string& text) { return !log.with(text).empty(); };
  const RunningNodelet front({{"no_input_warning_s", 1.0}}, "/front");
  std::optional<RunningNodelet> rear;
  rear.emplace(RunningNodelet::Parameters{{"no_input_warning_s", 1.0}},
               "/rear",
               ros::M_string{{"odom", "rear/odom"}, {"status", "rear/status"}});
  EXPECT_TRUE(diagnostics.says("front: tf", "/rear publishes tf odom -> base_link as well"));
  EXPECT_TRUE(diagnostics.says("rear: tf", "/front publishes tf odom -> base_link as well"));
  EXPECT_TRUE(waitUntil(
      [&] { return isLogged("/front: no stereo pair") && isLogged("/rear: no stereo pair"); }));
  rear.reset();
  EXPECT_TRUE(diagnostics.says("front: tf", "no conflict"));

  // Those of a frame that is not static are gone some seconds after they were sent.
  const std::string rival = "another nodelet in " + ros::this_node::getName() + " publishes tf ";
  tf2_ros::StaticTransformBroadcaster static_broadcaster;
  static_broadcaster.sendTransform(parentOfBase("world"));
  tf2_ros::TransformBroadcaster broadcaster;
  EXPECT_TRUE(waitUntil([&] {
    broadcaster.sendTransform(parentOfBase("map"));
    broadcaster.sendTransform(parentOfBase("wheel_odom"));
    return diagnostics.text("front: tf").find(rival + "map -> base_link") == 0 &&
           isLogged("/front: " + rival + "map -> base_link") &&
           isLogged("/front: " + rival + "wheel_odom -> base_link");
  }));
  EXPECT_TRUE(diagnostics.says("front: tf", rival + "world -> base_link"));
  for (const char* parent : {"map", "wheel_odom", "world"}) {
    EXPECT_EQ(log.with("/front: " + rival + parent + " -> base_link").size(), 1u) << parent;
  }
}

}  // namespace
}  // namespace rotrocc
