#pragma once

#include <string>

#include <ros/console.h>

namespace rotrocc {

/// The log of one odometry. Several may run in a process, so each line begins with the name of its
/// node or nodelet, if it has one.
class Log {
 public:
  explicit Log(const std::string& name = "") : prefix_(name.empty() ? "" : name + ": ") {}

  void info(const std::string& text) const { ROS_INFO_STREAM(prefix_ << text); }
  void warn(const std::string& text) const { ROS_WARN_STREAM(prefix_ << text); }
  void error(const std::string& text) const { ROS_ERROR_STREAM(prefix_ << text); }
  void fatal(const std::string& text) const { ROS_FATAL_STREAM(prefix_ << text); }

 private:
  std::string prefix_;
};

}  // namespace rotrocc
