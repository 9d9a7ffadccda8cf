// Replays a stereo bag: rosrun rotrocc kitti_player _bag:=FILE. The space bar pauses.

#include <chrono>
#include <exception>
#include <iostream>

#include <ros/ros.h>

#include "player/kitti_player.h"
#include "player/terminal_keys.h"

namespace {

void play() {
  ros::NodeHandle nh;
  ros::NodeHandle private_nh("~");
  rotrocc::KittiPlayer player(nh, private_nh, [] { ros::requestShutdown(); });
  rotrocc::TerminalKeys keys;
  if (keys.available()) ROS_INFO("press the space bar to pause");

  ros::AsyncSpinner spinner(1);
  spinner.start();
  while (ros::ok()) {
    if (keys.wait(std::chrono::milliseconds(100)) == ' ') player.setPaused(!player.paused());
  }
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "kitti_player");
  try {
    play();
  } catch (const std::exception& error) {
    std::cerr << "kitti_player: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
