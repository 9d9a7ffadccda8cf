#pragma once

#include <string>
#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Path.h>
#include <rosbag/bag.h>
#include <tf2_msgs/TFMessage.h>

namespace rotrocc {

/// The transforms of a bag, told apart into those to play and those that our odometry would contradict:
/// what gives the base a parent is a trajectory, not a mount. kitti2bag records world -> base_link for
/// raw drives; for odometry sequences it records world -> camera_left and no mount at all.
class RecordedTf {
 public:
  struct Frames {
    std::string odom = "odom";
    std::string base = "base_link";
    std::string camera;  ///< frame_id of the left image
  };

  /// Reads all transforms of `bag`. If none leads from the base to the camera, KITTI's mount is added
  /// to the static ones, and recorded poses of the camera are a trajectory too.
  RecordedTf(const rosbag::Bag& bag, const Frames& frames);

  bool addedKittiMount() const { return added_kitti_mount_; }

  /// The latest static transform of each child frame.
  const tf2_msgs::TFMessage& staticTransforms() const { return static_transforms_; }

  /// What is left of `message`, of the topic tf, to play.
  tf2_msgs::TFMessage transformsToPlay(const tf2_msgs::TFMessage& message) const;

  /// Pose of the base at each recorded pose, in the odom frame: relative to the first one. Empty if the
  /// bag records no trajectory.
  const nav_msgs::Path& trajectory() const { return trajectory_; }

  /// "world -> base_link", for messages.
  const std::string& trajectoryName() const { return trajectory_name_; }

 private:
  using Transforms = std::vector<geometry_msgs::TransformStamped>;

  bool isTrajectory(const geometry_msgs::TransformStamped& transform) const;
  bool hasMount(const Transforms& fixed, const Transforms& moving) const;
  void addStatic(const geometry_msgs::TransformStamped& transform);
  void addKittiMount();
  void buildTrajectory(const Transforms& moving);

  Frames frames_;
  tf2_msgs::TFMessage static_transforms_;
  bool added_kitti_mount_ = false;
  nav_msgs::Path trajectory_;
  std::string trajectory_name_;
};

}  // namespace rotrocc
