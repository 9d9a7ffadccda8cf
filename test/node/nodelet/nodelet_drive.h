#pragma once

#include <map>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include "node/node_parameters.h"
#include "node/stereo_odometry.h"
#include "support/diagnostics_listener.h"
#include "support/log_recorder.h"
#include "support/service_caller.h"
#include "support/simulated_robot.h"

namespace rotrocc {

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
