#pragma once

#include <string>

#include <nav_msgs/Path.h>
#include <tf2_msgs/TFMessage.h>
#include <Eigen/Geometry>

#include "bags/bag_reading.h"

namespace rotrocc {

/// The transforms of a recording. A parent of the base is a trajectory, not a mount. kitti2bag
/// records world -> base_link for raw drives; world -> camera_left and no mount for sequences.
struct RecordedTf {
  std::string base_frame;
  std::string camera_frame;  ///< of the left image
  /// No transform connects base and camera: one is added to the static ones, that of KITTI's car
  /// for a camera of kitti2bag, else mountAtCamera(). Recorded poses of the camera are a trajectory
  /// as well.
  bool assumes_mount = false;
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
  tf2_msgs::TFMessage static_transforms;  ///< the latest of each child frame
  /// Recorded poses as those of the base, relative to the first one. Empty if there are none.
  nav_msgs::Path trajectory;
  std::string trajectory_name;  ///< "world -> base_link", for messages

  /// Says which mount is assumed; empty if none is.
  std::string note() const;

  /// The transforms of a tf message to play.
  tf2_msgs::TFMessage transformsToPlay(const tf2_msgs::TFMessage& message) const;
};

/// Reads all transforms of `bags`. The frames may have leading slashes.
RecordedTf readTf(const Bags& bags, const std::string& base_frame, const std::string& camera_frame);

}  // namespace rotrocc
