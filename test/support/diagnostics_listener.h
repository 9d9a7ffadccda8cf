#pragma once

#include <map>
#include <mutex>
#include <string>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/node_handle.h>

#include "support/wait_until.h"

namespace rotrocc {

/// The latest entries of /diagnostics.
class DiagnosticsListener {
 public:
  DiagnosticsListener() {
    subscriber_ = ros::NodeHandle().subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", 100, [this](const diagnostic_msgs::DiagnosticArray::ConstPtr& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          for (const auto& status : message->status) texts_[status.name] = status.message;
        });
  }

  /// Waits for a text with that part in an entry, e.g. "stereo_odometry: tf".
  bool says(const std::string& entry, const std::string& part) {
    return waitUntil([&] { return text(entry).find(part) != std::string::npos; });
  }

  std::string text(const std::string& entry) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return texts_[entry];
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::string> texts_;
  ros::Subscriber subscriber_;
};

}  // namespace rotrocc
