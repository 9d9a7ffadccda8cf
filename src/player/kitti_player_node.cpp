#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <chrono>
#include <exception>
#include <iostream>
#include <optional>
#include <string>
#include <thread>

#include <ros/ros.h>

#include "common/print_help.h"
#include "player/kitti_player.h"
#include "player/player_options.h"

namespace {

const char* const kUsage =
    "Replays a stereo recording for an odometry, with /clock. The space bar pauses.\n\n"
    "example: rosrun rotrocc kitti_player _bag:=06.bag _rate:=2\n"
    "usage:   kitti_player _bag:=RECORDING [_PARAMETER:=VALUE...]\n\n"
    "It needs a ROS master with use_sim_time; kitti.launch starts all of it, with odometry and "
    "rviz.\n";

/// Reads single keys from the terminal, without line end and without echo. Restores the terminal at
/// the end of the scope.
class TerminalKeys {
 public:
  TerminalKeys() {
    // Only the process in the foreground may change the terminal.
    available_ =
        tcgetpgrp(STDIN_FILENO) == getpgrp() && tcgetattr(STDIN_FILENO, &settings_before_) == 0;
    if (!available_) return;
    termios settings = settings_before_;
    settings.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    changed_ = tcsetattr(STDIN_FILENO, TCSANOW, &settings) == 0;
  }
  ~TerminalKeys() {
    if (changed_) tcsetattr(STDIN_FILENO, TCSANOW, &settings_before_);
  }
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;

  /// Whether there is a terminal.
  bool available() const { return available_; }

  /// Waits for a key; returns none on timeout or without a terminal.
  std::optional<char> wait(std::chrono::milliseconds timeout) {
    if (!available_) {
      std::this_thread::sleep_for(timeout);
      return std::nullopt;
    }
    pollfd input = {STDIN_FILENO, POLLIN, 0};
    if (poll(&input, 1, static_cast<int>(timeout.count())) <= 0) return std::nullopt;
    char key = 0;
    if (read(STDIN_FILENO, &key, 1) == 1) return key;
    available_ = false;  // the terminal was closed
    return std::nullopt;
  }

 private:
  bool available_ = false;
  bool changed_ = false;
  termios settings_before_;
};

void play() {
  ros::NodeHandle nh;
  ros::NodeHandle private_nh("~");
  rotrocc::KittiPlayer player(nh, private_nh, [] { ros::requestShutdown(); });
  TerminalKeys keys;
  if (keys.available()) ROS_INFO("press the space bar to pause");

  ros::AsyncSpinner spinner(1);
  spinner.start();
  while (ros::ok()) {
    if (keys.wait(std::chrono::milliseconds(100)) == ' ') player.setPaused(!player.paused());
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string help = kUsage + rotrocc::describePlayerOptions();
  if (rotrocc::printHelp(argc, argv, help.c_str())) return 0;
  ros::init(argc, argv, "kitti_player");
  try {
    play();
  } catch (const std::exception& error) {
    std::cerr << "kitti_player: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
