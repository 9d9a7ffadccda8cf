#include <chrono>
#include <exception>
#include <iostream>

#include <ros/ros.h>

#include "common/print_help.h"
#include "player/kitti_player.h"
#include "player/terminal_keys.h"

namespace {

const char* const kHelp =
    "Replays a stereo bag for an odometry, with /clock. The space bar pauses.\n\n"
    "example: rosrun rotrocc kitti_player _bag:=06.bag _rate:=2\n"
    "usage:   kitti_player _bag:=FILE [_PARAMETER:=VALUE...]\n\n"
    "It needs a ROS master with use_sim_time; kitti.launch starts all of it, with odometry and "
    "rviz.\n\n"
    "Parameters:\n"
    "  bag                     path of the bag\n"
    "  left_image              topic of the left images, if the bag has several stereo pairs\n"
    "  right_image             topic of the right images\n"
    "  rate                    playback rate, default 1; 0: as fast as possible\n"
    "  start                   offset from the start of the bag [s]\n"
    "  duration                duration to play [s]; 0, the default: to the end\n"
    "  loop                    true: repeats the bag\n"
    "  paused                  true: starts paused\n"
    "  lockstep                true: waits for the odometry of each pair\n"
    "  lockstep_timeout_s      longest wait [s], default 10\n"
    "  max_stamp_difference_s  between the images of a pair [s], default 0.01\n"
    "  ground_truth_file       output of the true poses of the left camera, in TUM format\n"
    "  base_frame              frame whose recorded poses are ground truth, default base_link\n";

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
  if (rotrocc::printHelp(argc, argv, kHelp)) return 0;
  ros::init(argc, argv, "kitti_player");
  try {
    play();
  } catch (const std::exception& error) {
    std::cerr << "kitti_player: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
