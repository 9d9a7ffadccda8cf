#pragma once

#include <mutex>
#include <string>
#include <vector>

#include <ros/console.h>

namespace rotrocc {

/// Records the warnings and errors that this process logs from its construction on. At most one
/// instance at a time.
class LogRecorder {
 public:
  LogRecorder() {
    const std::lock_guard<std::mutex> lock(appender().mutex);
    appender().texts.clear();
  }
  LogRecorder(const LogRecorder&) = delete;
  LogRecorder& operator=(const LogRecorder&) = delete;

  /// Those that contain `part`.
  std::vector<std::string> with(const std::string& part) const {
    const std::lock_guard<std::mutex> lock(appender().mutex);
    std::vector<std::string> found;
    for (const std::string& text : appender().texts) {
      if (text.find(part) != std::string::npos) found.push_back(text);
    }
    return found;
  }

 private:
  struct Appender : ros::console::LogAppender {
    void log(ros::console::Level level,
             const char* text,
             const char* /*file*/,
             const char* /*function*/,
             int /*line*/) override {
      if (level < ros::console::levels::Warn) return;
      const std::lock_guard<std::mutex> lock(mutex);
      texts.emplace_back(text);
    }

    std::mutex mutex;
    std::vector<std::string> texts;
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
