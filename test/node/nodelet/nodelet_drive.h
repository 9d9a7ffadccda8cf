#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include "node/node_parameters.h"
#include "node/stereo_odometry.h"
#include "support/log_recorder.h"
#include "support/service_caller.h"
#include "support/simulated_robot.h"
#include "support/wait_until.h"

namespace rotrocc {

/// Time to wait for a message that may not come.
constexpr std::chrono::milliseconds kSoon(200);

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

/// The odometry of a nodelet in this process, with a thread for its callbacks: each message has
/// arrived as soon as it is published.
class RunningNodelet {
 public:
  using Parameters = std::map<std::string, XmlRpc::XmlRpcValue>;

  explicit RunningNodelet(const Parameters& parameters = {},
                          const std::string& name = "/stereo_odometry",
                          const ros::M_string& remappings = {})
      : nh_("/", remappings), private_nh_(name, remappings) {
    private_nh_.deleteParam(name);
    for (const auto& [key, value] : parameters) private_nh_.setParam(key, value);
    nh_.setCallbackQueue(&queue_);
    private_nh_.setCallbackQueue(&queue_);
    odometry_.emplace(nh_, private_nh_, name, readParameters(private_nh_));
    spinner_.start();
  }

  /// As when it is unloaded.
  void stop() {
    spinner_.stop();
    odometry_.reset();
  }

  /// Waits until it is done with what was published.
  void finish() {
    EXPECT_TRUE(waitUntil([this] { return queue_.isEmpty(); }));
  }

 private:
  ros::NodeHandle nh_, private_nh_;
  ros::CallbackQueue queue_;
  std::optional<StereoOdometry> odometry_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

/// The messages of a topic, received when they are asked for.
template <class Message>
class Received {
 public:
  explicit Received(const std::string& topic) {
    ros::NodeHandle nh;
    nh.setCallbackQueue(&queue_);
    const boost::function<void(const boost::shared_ptr<const Message>&)> keep =
        [this](const auto& message) { messages_.push_back(message); };
    subscriber_ = nh.subscribe<Message>(topic, 100, keep);
  }

  /// So far.
  const std::vector<boost::shared_ptr<const Message>>& all() {
    queue_.callAvailable();
    return messages_;
  }

  /// Null if none has come yet.
  boost::shared_ptr<const Message> last() { return all().empty() ? nullptr : messages_.back(); }

 private:
  ros::CallbackQueue queue_;
  std::vector<boost::shared_ptr<const Message>> messages_;
  ros::Subscriber subscriber_;
};

/// A nodelet on its robot.
struct NodeletDrive {
  explicit NodeletDrive(const RunningNodelet::Parameters& parameters = {}) : nodelet(parameters) {}

  /// camera_info and the mount of the camera.
  void setUp() {
    robot.publishInfos();
    robot.publishMount();
  }

  /// The answers to the pair of a stamp; empty messages after a failure.
  OdometryStatus statusOf(const ros::Time& stamp) {
    const auto status = robot.statusOf(stamp);
    EXPECT_TRUE(status) << "no status for " << stamp;
    return status.value_or(OdometryStatus());
  }
  nav_msgs::Odometry odometryOf(const ros::Time& stamp) {
    const auto odometry = robot.odometryOf(stamp);
    EXPECT_TRUE(odometry) << "no odometry for " << stamp;
    return odometry.value_or(nav_msgs::Odometry());
  }

  LogRecorder log;
  RunningNodelet nodelet;
  SimulatedRobot robot;
  ServiceCaller services{"/stereo_odometry"};
};

}  // namespace rotrocc
