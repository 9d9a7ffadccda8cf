#include <nodelet/loader.h>
#include <ros/init.h>
#include <ros/names.h>
#include <ros/node_handle.h>
#include <ros/this_node.h>

/// The nodelet rotrocc/StereoOdometry as a standalone node: same topics, same private parameters.
int main(int argc, char** argv) {
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
