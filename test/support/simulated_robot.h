#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <Eigen/Geometry>

#include "rotrocc/OdometryStatus.h"
#include "support/synthetic_scene.h"
#include "support/wait_until.h"

namespace rotrocc {

/// A robot that drives along the street of SyntheticScene: publishes the images of its stereo
/// camera, and keeps the answers of the odometry.
class SimulatedRobot {
 public:
  static constexpr double kStep_m = 0.4;    ///< forward, from each pair to the next
  static constexpr double kPeriod_s = 0.1;  ///< between them

  /// Waits until `odometries` have subscribed, and one has advertised its topics.
  explicit SimulatedRobot(std::uint32_t odometries = 1);

  /// After `change` of both.
  void publishInfos(const std::function<void(sensor_msgs::CameraInfo&)>& change = {});

  /// The transform from base_link to the camera, which is ahead of and above it.
  void publishMount();
  /// Of several broadcasters of a process, only the last one's transforms reach late subscribers.
  void publishStatic(const geometry_msgs::TransformStamped& transform) {
    tf_broadcaster_.sendTransform(transform);
  }

  /// Drives a step and publishes both images, after `change` to each of them. Returns their stamp.
  ros::Time drive(const std::function<void(sensor_msgs::Image&)>& change = {});

  /// The same in two steps: see() drives and returns both images, publish() publishes them. When it
  /// returns, subscribers in this process have received them.
  std::pair<sensor_msgs::Image, sensor_msgs::Image> see();
  void publish(const sensor_msgs::Image& left, const sensor_msgs::Image& right);

  /// The next pairs have stamps from a time on.
  void setTime(const ros::Time& stamp) { stamp_ = stamp; }

  /// The camera looks to the left of the way by that angle from the next pair on.
  void look(double left_rad) { left_rad_ = left_rad; }

  /// The answer to the pair of a stamp; nothing after the timeout.
  std::optional<nav_msgs::Odometry> odometryOf(const ros::Time& stamp,
                                               std::chrono::milliseconds timeout = kHangLimit);
  std::optional<OdometryStatus> statusOf(const ros::Time& stamp,
                                         std::chrono::milliseconds timeout = kHangLimit);

  /// The first answer to a pair of that stamp or a later one.
  std::optional<nav_msgs::Odometry> odometryFrom(const ros::Time& stamp);

  /// Waits for a status that fits, or with a state and a reason that contains `reason`; nothing
  /// after the timeout.
  std::optional<OdometryStatus> statusThat(const std::function<bool(const OdometryStatus&)>& fits,
                                           std::chrono::milliseconds timeout = kHangLimit);
  std::optional<OdometryStatus> statusWith(std::uint8_t state,
                                           const std::string& reason = "",
                                           std::chrono::milliseconds timeout = kHangLimit);

 private:
  template <class Message>
  void keep(const Message& message, std::map<ros::Time, Message>& messages);
  template <class Message>
  std::optional<Message> waitFor(const ros::Time& stamp,
                                 const std::map<ros::Time, Message>& messages,
                                 std::chrono::milliseconds timeout);

  SyntheticScene scene_;
  double way_m_ = 0.0;
  double left_rad_ = 0.0;
  ros::Time stamp_{1000.0};

  std::mutex mutex_;
  std::condition_variable received_;
  std::map<ros::Time, nav_msgs::Odometry> odometry_;
  std::map<ros::Time, OdometryStatus> status_;
  OdometryStatus last_status_;

  tf2_ros::StaticTransformBroadcaster tf_broadcaster_;
  ros::Publisher left_image_publisher_;
  ros::Publisher right_image_publisher_;
  ros::Publisher left_info_publisher_;
  ros::Publisher right_info_publisher_;
  ros::Subscriber odom_subscriber_;
  ros::Subscriber status_subscriber_;
};

}  // namespace rotrocc
