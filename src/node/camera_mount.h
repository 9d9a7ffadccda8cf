#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include <geometry_msgs/Transform.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <Eigen/Geometry>

#include "input/log.h"
#include "input/throttle.h"

namespace rotrocc {

/// Pose of the camera on the robot, from tf. Assumed to be fixed: it is looked up once.
class CameraMount {
 public:
  explicit CameraMount(const std::string& base_frame, Log log = Log());
  CameraMount(const CameraMount&) = delete;
  CameraMount& operator=(const CameraMount&) = delete;

  /// T_base_camera, or nothing if tf does not have it yet; does not wait. Logs the camera pose or,
  /// after repeated calls, the missing frames.
  const std::optional<Eigen::Isometry3d>& find(const std::string& camera_frame);

  /// The transform that find() is missing, in one sentence; empty if found.
  const std::string& missing() const { return missing_; }

 private:
  std::string base_frame_;
  Log log_;
  std::optional<Eigen::Isometry3d> T_base_camera_;
  std::string missing_;
  int attempts_ = 0;
  Throttle warning_{std::chrono::seconds(5)};
  tf2_ros::Buffer buffer_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;  // until the mount is found
};

/// Throws std::invalid_argument with the value if a number is not finite, or the length of the
/// quaternion differs from 1 by more than 1 %.
Eigen::Isometry3d toEigen(const geometry_msgs::Transform& transform);

/// "at 0 0 1.65 m, looks along +x (forward), its image is upright": for a user to check the camera
/// pose.
std::string describeMount(const Eigen::Isometry3d& T_base_camera);

}  // namespace rotrocc
