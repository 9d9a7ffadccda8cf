#pragma once

#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <ros/console.h>

namespace rotrocc {

/// Records what this process logs from its construction on. At most one instance at a time.
class LogRecorder {
 public:
  LogRecorder() {
    const std::lock_guard<std::mutex> lock(appender().mutex);
    appender().texts.clear();
  }
  LogRecorder(const LogRecorder&) = delete;
  LogRecorder& operator=(const LogRecorder&) = delete;

  /// "file:line" of the last one.
  std::string lastCaller() const {
    const std::lock_guard<std::mutex> lock(appender().mutex);
    return appender().last_caller;
  }

  /// The warnings and errors that contain `part`, or those of a lower level as well.
  std::vector<std::string> with(const std::string& part,
                                ros::console::Level least = ros::console::levels::Warn) const {
    const std::lock_guard<std::mutex> lock(appender().mutex);
    std::vector<std::string> found;
    for (const auto& [level, text] : appender().texts) {
      if (level >= least && text.find(part) != std::string::npos) found.push_back(text);
    }
    return found;
  }

 private:
  struct Appender : ros::console::LogAppender {
    void log(ros::console::Level level,
             const char* text,
             const char* file,
             const char* /*function*/,
             int line) override {
      const std::lock_guard<std::mutex> lock(mutex);
      texts.emplace_back(level, text);
      last_caller = std::string(file) + ":" + std::to_string(line);
    }

    std::mutex mutex;
    std::vector<std::pair<ros::console::Level, std::string>> texts;
    std::string last_caller;
  };

  /// Stays registered until the process ends: deregistering crashes in rosconsole of Debian 11.
  static Appender& appender() {
    static Appender* const appender = [] {
      auto* const registered = new Appender;
      ros::console::register_appender(registered);
      return registered;
    }();
    return *appender;
  }
};

}  // namespace rotrocc
