#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>

#include <ros/console.h>

namespace rotrocc {

/// The log of one odometry. Several may run in a process: each has a logger of its own, that of the
/// NODELET macros, whose level can be set, and each line begins with the name of its node or
/// nodelet, if it has one.
class Log {
 public:
  /// Where a line comes from, for rosout and rqt_console.
  struct Caller {
    Caller(const char* file_ = __builtin_FILE(),
           int line_ = __builtin_LINE(),
           const char* function_ = __builtin_FUNCTION())
        : file(file_), line(line_), function(function_) {}

    const char* file;
    int line;
    const char* function;
  };

  explicit Log(const std::string& name = "") : name_(name) {}

  using Level = ros::console::Level;
  void info(const std::string& text, const Caller& caller = {}) const {
    write(Level::Info, text, caller);
  }
  void warn(const std::string& text, const Caller& caller = {}) const {
    write(Level::Warn, text, caller);
  }
  void error(const std::string& text, const Caller& caller = {}) const {
    write(Level::Error, text, caller);
  }
  void fatal(const std::string& text, const Caller& caller = {}) const {
    write(Level::Fatal, text, caller);
  }

 private:
  void write(Level level, const std::string& text, const Caller& caller) const;

  std::string name_;
};

/// Limits the rate of log messages in real time: throttled logging of ROS uses simulated time,
/// which may stand still or jump.
class Throttle {
 public:
  using Duration = std::chrono::milliseconds;

  /// The period doubles up to `longest`, if there is one, until there is no call for `period`.
  explicit Throttle(Duration period, std::optional<Duration> longest = {})
      : first_(period), longest_(longest.value_or(period)) {}

  using Time = std::chrono::steady_clock::time_point;

  /// Whether the period has passed since this returned true.
  bool pass(Time now = std::chrono::steady_clock::now());

 private:
  Duration first_, longest_, wait_{};
  std::optional<Time> asked_;
  Time not_before_;
};

/// Tells faults that last: each at once, then more and more seldom. Those that differ in numbers
/// only are one.
class FaultThrottle {
 public:
  bool pass(const std::string& fault, Throttle::Time now = std::chrono::steady_clock::now());

 private:
  std::map<std::string, Throttle> throttles_;
};

}  // namespace rotrocc
