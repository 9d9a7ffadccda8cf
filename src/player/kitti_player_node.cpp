#include <exception>
#include <iostream>
#include <string>

#include <ros/ros.h>

#include "common/print_help.h"
#include "player/kitti_player.h"
#include "player/player_options.h"

namespace {

const char* const kUsage =
    "Replays a stereo recording for an odometry, with /clock.\n\n"
    "example: rosrun rotrocc kitti_player _bag:=06.bag _rate:=2\n"
    "usage:   kitti_player _bag:=RECORDING [_PARAMETER:=VALUE...]\n\n"
    "It needs a ROS master with use_sim_time; replay.launch starts all of it, with odometry and "
    "rviz.\n";

}  // namespace

int main(int argc, char** argv) {
  const std::string help = kUsage + rotrocc::describePlayerOptions();
  if (rotrocc::printHelp(argc, argv, help.c_str())) return 0;
  ros::init(argc, argv, "kitti_player");
  try {
    ros::NodeHandle nh;
    ros::NodeHandle private_nh("~");
    const rotrocc::KittiPlayer player(nh, private_nh, [] { ros::requestShutdown(); });
    ros::spin();
  } catch (const std::exception& error) {
    std::cerr << "kitti_player: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
