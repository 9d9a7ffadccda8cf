#include "input/log.h"

#include <algorithm>
#include <array>
#include <mutex>

#include <boost/algorithm/string/classification.hpp>
#include <boost/range/algorithm_ext/erase.hpp>

namespace rotrocc {
namespace {

using ros::console::LogLocation;

/// What rosconsole knows of a level of a logger. It never forgets its address.
LogLocation& locationOf(const std::string& name, Log::Level level) {
  static std::mutex mutex;
  static auto* const loggers =
      new std::map<std::string, std::array<LogLocation, ros::console::levels::Count>>;
  const std::lock_guard<std::mutex> lock(mutex);
  LogLocation& location = (*loggers)[name][level];
  if (!location.initialized_) {
    const std::string logger = ROSCONSOLE_DEFAULT_NAME + (name.empty() ? "" : "." + name);
    ros::console::initializeLogLocation(&location, logger, level);
  }
  return location;
}

/// A fault without its numbers.
std::string causeOf(std::string fault) {
  return boost::range::remove_erase_if(fault, boost::algorithm::is_digit());
}

}  // namespace

void Log::write(Level level, const std::string& text, const Caller& caller) const {
  ROSCONSOLE_AUTOINIT;
  const LogLocation& location = locationOf(name_, level);
  if (!location.logger_enabled_) return;
  const std::string line = name_.empty() ? text : name_ + ": " + text;
  ros::console::print(nullptr,
                      location.logger_,
                      level,
                      caller.file,
                      caller.line,
                      caller.function,
                      "%s",
                      line.c_str());
}

bool Throttle::pass(Time now) {
  if (!asked_ || now - *asked_ >= first_) {
    wait_ = first_;
    not_before_ = now;
  }
  asked_ = now;
  if (now < not_before_) return false;
  not_before_ = now + wait_;
  wait_ = std::min(2 * wait_, longest_);
  return true;
}

bool FaultThrottle::pass(const std::string& fault, Throttle::Time now) {
  return throttles_[causeOf(fault)].pass(now);
}

std::string LastingFault::observe(const std::string& fault, Throttle::Time now) {
  const std::string cause = causeOf(fault);
  if (cause != cause_) {
    cause_ = cause;
    since_ = now;
  }
  return now - since_ > window_ ? fault : "";
}

}  // namespace rotrocc
