#pragma once

#include <mutex>
#include <string>
#include <vector>

#include <ros/console.h>

namespace rotrocc {

/// Records the warnings and errors that this process logs. At most one instance at a time.
class LogRecorder : public ros::console::LogAppender {
 public:
  LogRecorder() { ros::console::register_appender(this); }
  ~LogRecorder() override { ros::console::deregister_appender(this); }
  LogRecorder(const LogRecorder&) = delete;
  LogRecorder& operator=(const LogRecorder&) = delete;

  void log(ros::console::Level level,
           const char* text,
           const char* /*file*/,
           const char* /*function*/,
           int /*line*/) override {
    if (level < ros::console::levels::Warn) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    texts_.emplace_back(text);
  }

  /// Those that contain `part`.
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

}  // namespace rotrocc
