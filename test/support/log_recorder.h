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
  LogRecorder() { appender().clear(); }
  LogRecorder(const LogRecorder&) = delete;
  LogRecorder& operator=(const LogRecorder&) = delete;

  /// Those that contain `part`.
  std::vector<std::string> with(const std::string& part) const { return appender().with(part); }

 private:
  class Appender : public ros::console::LogAppender {
   public:
    void log(ros::console::Level level,
             const char* text,
             const char* /*file*/,
             const char* /*function*/,
             int /*line*/) override {
      if (level < ros::console::levels::Warn) return;
      const std::lock_guard<std::mutex> lock(mutex_);
      texts_.emplace_back(text);
    }

    void clear() {
      const std::lock_guard<std::mutex> lock(mutex_);
      texts_.clear();
    }

    std::vector<std::string> with(const std::string& part) const {
      const std::lock_guard<std::mutex> lock(mutex_);
      std::vector<std::string> found;
      for (const std::string& text : texts_) {
        if (text.find(part) != std::string::npos) found.push_back(text);
      }
      return found;
    }

   private:
    mutable std::mutex mutex_;
    std::vector<std::string> texts_;
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
