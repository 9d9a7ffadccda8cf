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
  void write(Level level, const std::string& text, const Caller& caller = {}) const;
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
  std::string name_;
};

/// Limits the rate of log messages in real time: throttled logging of ROS uses simulated time,
/// which may stand still or jump.
class Throttle {
 public:
  using Duration = std::chrono::milliseconds;

  /// Of a fault: after 30 s, and while it lasts, at growing intervals up to each 5 minutes.
  Throttle() : first_(std::chrono::seconds(30)), longest_(std::chrono::minutes(5)) {}
  explicit Throttle(Duration period) : first_(period), longest_(period) {}

  using Time = std::chrono::steady_clock::time_point;

  /// Whether the period has passed since this returned true. It doubles if it is to grow, until
  /// there is no call for as long as the first one.
  bool pass(Time now = std::chrono::steady_clock::now());

 private:
  Duration first_, longest_, wait_{};
  std::optional<Time> asked_;
  Time not_before_;
};

/// A throttle for each fault. Those that differ in numbers only are one.
class FaultThrottle {
 public:
  bool pass(const std::string& fault, Throttle::Time now = std::chrono::steady_clock::now());

 private:
  std::map<std::string, Throttle> throttles_;
};

/// Suppresses a fault until it has persisted for longer than the time windows that detect it, which
/// initially contain older data, too.
class LastingFault {
 public:
  explicit LastingFault(Throttle::Duration window) : window_(window) {}

  /// Returns the current fault if it lasts, otherwise empty. Call it also if there is none.
  std::string observe(const std::string& fault,
                      Throttle::Time now = std::chrono::steady_clock::now());

 private:
  Throttle::Duration window_;
  std::string cause_;
  Throttle::Time since_;
};

}  // namespace rotrocc
