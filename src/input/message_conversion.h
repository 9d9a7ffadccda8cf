#pragma once

#include <cstdint>
#include <string>

#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>
#include <sensor_msgs/Imu.h>
#include <tf2_eigen/tf2_eigen.h>

#include "inertial/gyro_history.h"

namespace rotrocc {

/// The frame as tf2 names it: without the leading slash of tf.
inline std::string withoutSlash(const std::string& frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

inline std::int64_t toNanoseconds(const ros::Time& stamp) {
  return static_cast<std::int64_t>(stamp.toNSec());
}

/// `stamp_ns` must not be negative: ROS has no times before 1970.
inline ros::Time toRosTime(std::int64_t stamp_ns) {
  return ros::Time().fromNSec(static_cast<std::uint64_t>(stamp_ns));
}

/// T_parent_child as tf message.
inline geometry_msgs::TransformStamped toTransform(const Eigen::Isometry3d& T_parent_child,
                                                   std::int64_t stamp_ns,
                                                   const std::string& parent,
                                                   const std::string& child) {
  geometry_msgs::TransformStamped message = tf2::eigenToTransform(T_parent_child);
  message.header.stamp = toRosTime(stamp_ns);
  message.header.frame_id = parent;
  message.child_frame_id = child;
  return message;
}

inline GyroSample toGyroSample(const sensor_msgs::Imu& message) {
  const geometry_msgs::Vector3& rate = message.angular_velocity;
  return {toNanoseconds(message.header.stamp), {rate.x, rate.y, rate.z}};
}

}  // namespace rotrocc
