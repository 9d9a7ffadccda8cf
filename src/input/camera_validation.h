#pragma once

#include <string>

#include <sensor_msgs/CameraInfo.h>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// The stereo camera that the projection matrices P of two rectified cameras describe. K, D and R
/// are ignored: they belong to the images before rectification. A non-zero P[3] of the left camera,
/// as for KITTI's colour cameras, is subtracted from the baseline. As in image_geometry, the offset
/// of roi is subtracted from the principal point before dividing by the binning. `baseline_m` > 0
/// replaces the baseline from P[3]. Throws InputError with the value and a remedy if P is not a
/// rectified pinhole camera, if the two differ in size, focal length or cy, or if the right camera
/// is not to the right of the left one.
StereoCamera toStereoCamera(const sensor_msgs::CameraInfo& left,
                            const sensor_msgs::CameraInfo& right,
                            double baseline_m = 0.0);

/// Throws InputError for a camera_info, with the sentence.
[[noreturn]] void refuseCameraInfo(const std::string& sentence);

/// A warning about an unlikely camera, e.g. with a baseline in millimetres; empty if none.
std::string oddityOf(const StereoCamera& camera);

}  // namespace rotrocc
