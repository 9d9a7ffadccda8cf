// Two odometries in one process that publish the same tf, and rivals elsewhere.

#include <optional>

#include <tf2_ros/transform_broadcaster.h>

#include "nodelet_drive.h"

namespace rotrocc {
namespace {

void sendTf(tf2_ros::TransformBroadcaster& broadcaster, const std::string& parent) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.child_frame_id = "base_link";
  transform.transform.rotation.w = 1.0;
  broadcaster.sendTransform(transform);
}

TEST(TfRivalsTest, NameEachOtherAndOthersUntilTheyAreGone) {
  DiagnosticsListener diagnostics;
  const LogRecorder log;
  const auto isLogged = [&](const std::string& text) { return !log.with(text).empty(); };
  const RunningNodelet front({{"silence_s", 1.0}}, "/front");
  std::optional<RunningNodelet> rear;
  rear.emplace(RunningNodelet::Parameters{{"silence_s", 1.0}},
               "/rear",
               ros::M_string{{"odom", "rear/odom"}, {"status", "rear/status"}});
  EXPECT_TRUE(diagnostics.says("front: tf", "/rear publishes tf odom -> base_link as well"));
  EXPECT_TRUE(diagnostics.says("rear: tf", "/front publishes tf odom -> base_link as well"));
  EXPECT_TRUE(waitUntil(
      [&] { return isLogged("/front: no stereo pair") && isLogged("/rear: no stereo pair"); }));
  rear.reset();
  EXPECT_TRUE(diagnostics.says("front: tf", "no conflict"));

  tf2_ros::TransformBroadcaster broadcaster;
  const std::string rival = "another nodelet in " + ros::this_node::getName() + " publishes tf ";
  EXPECT_TRUE(waitUntil([&] {
    sendTf(broadcaster, "map");
    sendTf(broadcaster, "wheel_odom");
    return diagnostics.text("front: tf").find(rival + "map -> base_link") == 0 &&
           isLogged("/front: " + rival + "map -> base_link") &&
           isLogged("/front: " + rival + "wheel_odom -> base_link");
  }));
  EXPECT_TRUE(diagnostics.says("front: tf", "no conflict"));
}

}  // namespace
}  // namespace rotrocc
