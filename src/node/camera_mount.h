#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include <geometry_msgs/Transform.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <Eigen/Geometry>

#include "input/throttle.h"

namespace rotrocc {

/// Where a camera is mounted on the robot: from tf, which is waited for and never assumed. The
/// mount is taken to be fixed: it is looked up once.
class CameraMount {
 public:
  explicit CameraMount(const std::string& base_frame);
  CameraMount(const CameraMount&) = delete;
  CameraMount& operator=(const CameraMount&) = delete;

  /// T_base_camera, or nothing as long as tf does not know it; does not wait. Says in the log where
  /// the camera is, or, if asked again and again, which frames are missing.
  const std::optional<Eigen::Isometry3d>& find(const std::string& camera_frame);

  /// What find() looks for in vain, in one sentence; empty if it has found it.
  const std::string& missing() const { return missing_; }

 private:
  std::string base_frame_;
  std::optional<Eigen::Isometry3d> T_base_camera_;
  std::string missing_;
  int attempts_ = 0;
  Throttle warning_{std::chrono::seconds(5)};
  tf2_ros::Buffer buffer_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;  // until the mount is found
};

/// Throws std::invalid_argument with the value if there is a number that is not finite, or the
/// quaternion is not of unit length within 1 %.
Eigen::Isometry3d toEigen(const geometry_msgs::Transform& transform);

/// "at 0 0 1.65 m, looks along +x (forward), its image is upright": for a human to check a mount
/// with.
std::string describeMount(const Eigen::Isometry3d& T_base_camera);

}  // namespace rotrocc
