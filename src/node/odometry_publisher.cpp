#include "node/odometry_publisher.h"

#include <chrono>
#include <cmath>
#include <utility>

#include <cv_bridge/cv_bridge.h>
#include <nav_msgs/Path.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_msgs/TFMessage.h>
#include <boost/make_shared.hpp>

#include "input/message_conversion.h"
#include "node/advertise.h"
#include "node/tf/tf_conflict.h"
#include "rotrocc/flow_picture.h"

namespace rotrocc {
namespace {

/// Enough for a subscriber that is briefly busy.
constexpr int kMotionQueue = 50;
/// Only the latest of large messages.
constexpr int kPictureQueue = 1;
/// Poses of the path: 1000 s at 10 Hz, in 640 kB. Longer ones fill the network, and rviz is slow.
constexpr std::size_t kPathLength = 10'000;

/// Like that of a broadcaster: tf is not remapped for a nodelet. A broadcaster sends by way of the
/// network thread even to receivers in this process.
ros::Publisher advertiseTf() {
  ros::NodeHandle nh;
  return advertise<tf2_msgs::TFMessage>(nh, "/tf", kMotionQueue);
}

/// Pose and twist are zero, with a variance that says that nothing is known.
BaseState unknownAt(std::int64_t stamp_ns) {
  BaseState unknown;
  unknown.stamp_ns = stamp_ns;
  unknown.T_odom_base.covariance = kUnknownVariance * Matrix6d::Identity();
  unknown.twist.covariance = kUnknownVariance * Matrix6d::Identity();
  return unknown;
}

}  // namespace

OdometryPublisher::OdometryPublisher(ros::NodeHandle& nh, const NodeParameters& parameters)
    : parameters_(parameters),
      path_throttle_(std::chrono::milliseconds(std::lround(1e3 / parameters.path_rate_hz))),
      tf_publisher_(parameters.publish_tf ? advertiseTf() : ros::Publisher()),
      odom_publisher_(advertise<nav_msgs::Odometry>(nh, "odom", kMotionQueue)),
      twist_publisher_(
          advertise<geometry_msgs::TwistWithCovarianceStamped>(nh, "twist", kMotionQueue)),
      status_publisher_(advertise<OdometryStatus>(nh, "status", kMotionQueue)),
      path_publisher_(advertise<nav_msgs::Path>(nh, "path", kPictureQueue)),
      inliers_publisher_(advertise<sensor_msgs::PointCloud2>(nh, "inliers", kPictureQueue)),
      flow_publisher_(image_transport::ImageTransport(nh).advertise("flow", kPictureQueue)) {}

std::chrono::steady_clock::time_point OdometryPublisher::publishMotion(
    const BaseState& state, bool is_lost, const std::optional<Eigen::Isometry3d>& T_guess_base) {
  const bool is_unknown = is_lost && parameters_.while_lost != "hold";
  const auto odometry = boost::make_shared<nav_msgs::Odometry>(
      toOdometry(is_unknown ? unknownAt(state.stamp_ns) : state,
                 parameters_.odom_frame,
                 parameters_.base_frame));
  if (tf_publisher_ && !is_unknown) publishTf(state, T_guess_base);
  const auto sent = std::chrono::steady_clock::now();
  if (is_lost && parameters_.while_lost == "silent") return sent;
  odom_publisher_.publish(odometry);
  if (state.step_velocity) {
    twist_publisher_.publish(toTwist(*state.step_velocity, parameters_.base_frame));
  }
  return sent;
}

/// With another odometry of the base, tf is published up to its odom frame: a frame has only one
/// parent.
void OdometryPublisher::publishTf(const BaseState& state,
                                  const std::optional<Eigen::Isometry3d>& T_guess_base) {
  Eigen::Isometry3d T_parent_child = state.T_odom_base.T;
  if (!parameters_.guess_frame.empty()) {
    if (!T_guess_base) return;
    T_parent_child = T_parent_child * T_guess_base->inverse();
  } else if (parameters_.invert_tf) {
    T_parent_child = T_parent_child.inverse();
  }
  const PublishedTf frames = publishedTf("", parameters_);
  const auto message = boost::make_shared<tf2_msgs::TFMessage>();
  message->transforms.push_back(
      toTransform(T_parent_child, state.stamp_ns, frames.parent, frames.child));
  tf_publisher_.publish(message);
}

void OdometryPublisher::publishStatus(OdometryStatus status) {
  status_publisher_.publish(boost::make_shared<OdometryStatus>(std::move(status)));
}

void OdometryPublisher::publishPath(const BaseState& state, bool starts) {
  if (starts) path_.clear();
  path_.emplace_back();
  path_.back().header.stamp = toRosTime(state.stamp_ns);
  path_.back().header.frame_id = parameters_.odom_frame;
  path_.back().pose = tf2::toMsg(state.T_odom_base.T);
  while (path_.size() > kPathLength) path_.pop_front();
  if (path_publisher_.getNumSubscribers() == 0 || !path_throttle_.pass()) return;
  const auto path = boost::make_shared<nav_msgs::Path>();
  path->header.stamp = toRosTime(state.stamp_ns);
  path->header.frame_id = parameters_.odom_frame;
  path->poses.assign(path_.begin(), path_.end());
  path_publisher_.publish(path);
}

void OdometryPublisher::publishPictures(const PairInput& in,
                                        const OdometryResult& result,
                                        const VisualOdometry& odometry,
                                        const std::string& camera_frame) {
  const cv::Mat& left = in.pair.left;
  std_msgs::Header header;
  header.stamp = toRosTime(result.stamp_ns);
  header.frame_id = camera_frame;
  if (inliers_publisher_.getNumSubscribers() > 0) {
    inliers_publisher_.publish(boost::make_shared<sensor_msgs::PointCloud2>(
        toPointCloud(odometry.correspondences(), odometry.translationInliers(), left, header)));
  }
  if (flow_publisher_.getNumSubscribers() > 0) {
    drawFlowPicture({in.pair,
                     in.camera,
                     odometry.correspondences(),
                     odometry.rotationInliers(),
                     odometry.translationInliers(),
                     result},
                    picture_);
    flow_publisher_.publish(cv_bridge::CvImage(header, "bgr8", picture_).toImageMsg());
  }
}

}  // namespace rotrocc
