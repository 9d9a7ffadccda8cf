#pragma once

#include <cstdint>

#include <ros/time.h>
#include <sensor_msgs/CameraInfo.h>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// The stereo camera that the projection matrices P of two rectified cameras describe. K, D and R
/// are not looked at: they belong to the images before rectification. A non-zero P[3] of the left
/// camera, as the colour cameras of KITTI have it, is taken off the baseline. As in image_geometry,
/// the offset of roi is taken off the principal point, and then all is divided by the binning.
/// Throws std::invalid_argument that quotes the value if P is no rectified pinhole camera, if the
/// two differ in size, focal length or cy, or if the right camera is not to the right of the left
/// one.
StereoCamera toStereoCamera(const sensor_msgs::CameraInfo& left,
                            const sensor_msgs::CameraInfo& right);

inline std::int64_t toNanoseconds(const ros::Time& stamp) {
  return static_cast<std::int64_t>(stamp.toNSec());
}

/// `stamp_ns` must not be negative: ROS has no times before 1970.
inline ros::Time toRosTime(std::int64_t stamp_ns) {
  return ros::Time().fromNSec(static_cast<std::uint64_t>(stamp_ns));
}

}  // namespace rotrocc
