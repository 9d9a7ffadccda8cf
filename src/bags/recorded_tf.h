#pragma once

#include <string>
#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Path.h>
#include <rosbag/bag.h>
#include <tf2_msgs/TFMessage.h>
#include <Eigen/Geometry>

#include "sequences/kitti_mount.h"

namespace rotrocc {

/// Separates the transforms of a bag into those to play and those that conflict with the odometry:
/// a parent of the base is a trajectory, not a mount. kitti2bag records world -> base_link for raw
/// drives; for odometry sequences it records world -> camera_left and no mount.
class RecordedTf {
 public:
  /// Reads all transforms of `bag`. `camera_frame` is the frame of the left image. If no transform
  /// connects base and camera, KITTI's mount is added to the static ones, and recorded poses of the
  /// camera are a trajectory as well.
  RecordedTf(const rosbag::Bag& bag,
             const std::string& base_frame,
             const std::string& camera_frame);

  bool addedKittiMount() const { return added_kitti_mount_; }
  const Eigen::Isometry3d& T_base_camera() const { return T_base_camera_; }

  /// The latest static transform of each child frame.
  const tf2_msgs::TFMessage& staticTransforms() const { return static_transforms_; }

  /// The transforms of a tf message to play.
  tf2_msgs::TFMessage transformsToPlay(const tf2_msgs::TFMessage& message) const;

  /// Poses of the base for the recorded poses, relative to the first one, i.e. in the frame "odom".
  /// Empty if the bag has no trajectory.
  const nav_msgs::Path& trajectory() const { return trajectory_; }

  /// "world -> base_link", for messages.
  const std::string& trajectoryName() const { return trajectory_name_; }

 private:
  using Transforms = std::vector<geometry_msgs::TransformStamped>;

  bool isTrajectory(const geometry_msgs::TransformStamped& transform) const;
  bool findMount(const Transforms& fixed, const Transforms& moving);
  void addStatic(const geometry_msgs::TransformStamped& transform);
  void addKittiMount();
  void buildTrajectory(const Transforms& moving);

  std::string base_frame_;
  std::string camera_frame_;
  tf2_msgs::TFMessage static_transforms_;
  bool added_kitti_mount_ = false;
  Eigen::Isometry3d T_base_camera_ = kittiMount();
  nav_msgs::Path trajectory_;
  std::string trajectory_name_;
};

}  // namespace rotrocc
