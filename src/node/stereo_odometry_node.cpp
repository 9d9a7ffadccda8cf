#include <nodelet/loader.h>
#include <ros/init.h>
#include <ros/names.h>
#include <ros/node_handle.h>
#include <ros/this_node.h>

#include "common/print_help.h"

namespace {

const char* const kHelp =
    "Live stereo odometry as a node: rectified stereo images in, odometry and tf out.\n\n"
    "example: ROS_NAMESPACE=camera rosrun rotrocc stereo_odometry _base_frame:=base_link\n"
    "usage:   stereo_odometry [_PARAMETER:=VALUE...] [TOPIC:=TOPIC...]\n\n"
    "It needs a ROS master; stereo_odometry.launch starts the same as a nodelet. Subscribes to\n"
    "left/image_rect, left/camera_info and the same on the right. docs/node.md has all topics and\n"
    "services, config/default.yaml all parameters with unit and range.\n";

}  // namespace

/// The nodelet rotrocc/StereoOdometry as a standalone node: same topics, same private parameters.
int main(int argc, char** argv) {
  if (rotrocc::printHelp(argc, argv, kHelp)) return 0;
  ros::init(argc, argv, "stereo_odometry");
  const ros::NodeHandle keeps_ros_alive_until_the_loader_is_gone;
  nodelet::Loader loader(false);
  const nodelet::V_string arguments(argv + 1, argv + argc);
  const bool loaded = loader.load(
      ros::this_node::getName(), "rotrocc/StereoOdometry", ros::names::getRemappings(), arguments);
  if (!loaded) return 1;
  ros::spin();
  return 0;
}
