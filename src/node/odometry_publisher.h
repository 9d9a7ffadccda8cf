#pragma once

#include <chrono>
#include <deque>
#include <optional>

#include <geometry_msgs/PoseStamped.h>
#include <image_transport/image_transport.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <opencv2/core.hpp>

#include "input/log.h"
#include "node/base/pair_processor.h"
#include "node/odometry_messages.h"
#include "rotrocc/OdometryStatus.h"
#include "rotrocc/parameters.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// Publishes the results of each pair: tf, odom, twist, status, path, inliers and flow. The last
/// two cost nothing without subscribers. The path is sent at a limited rate, because it is long;
/// its poses are kept for those who subscribe later.
class OdometryPublisher {
 public:
  OdometryPublisher(ros::NodeHandle& nh, const NodeParameters& parameters);

  /// tf, odom and twist; tf first, so that receivers of the odometry already have it. If the motion
  /// is lost, what while_lost says.
  /// `T_guess_base`: the pose of the base in guess_frame at that time, if there is such a frame and
  /// tf knows it. Returns when odom was sent: receivers that it wakes may be served before this.
  std::chrono::steady_clock::time_point publishMotion(
      const BaseState& state, bool is_lost, const std::optional<Eigen::Isometry3d>& T_guess_base);

  void publishStatus(OdometryStatus status);

  /// Adds a pose to the path, or to a new one, and publishes it.
  void publishPath(const BaseState& state, bool starts);

  /// Publishes inliers and flow of the last call of odometry.process(), which gave `result`.
  void publishPictures(const PairInput& in,
                       const OdometryResult& result,
                       const VisualOdometry& odometry,
                       const std::string& camera_frame);

 private:
  void publishTf(const BaseState& state, const std::optional<Eigen::Isometry3d>& T_guess_base);

  NodeParameters parameters_;
  std::deque<geometry_msgs::PoseStamped> path_;
  Throttle path_throttle_;
  cv::Mat picture_;

  // roscpp sends what waits for its network thread in the order of advertising.
  ros::Publisher tf_publisher_;  // unless publish_tf is false
  ros::Publisher odom_publisher_;
  ros::Publisher twist_publisher_;
  ros::Publisher status_publisher_;
  ros::Publisher path_publisher_;
  ros::Publisher inliers_publisher_;
  image_transport::Publisher flow_publisher_;
};

}  // namespace rotrocc
