#pragma once

#include <string>

#include <sensor_msgs/CameraInfo.h>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// The stereo camera that the projection matrices P of two rectified cameras describe. K, D and R
/// are not looked at: they belong to the images before rectification. A non-zero P[3] of the left
/// camera, as the colour cameras of KITTI have it, is taken off the baseline. As in image_geometry,
/// the offset of roi is taken off the principal point, and then all is divided by the binning.
/// `baseline_m` > 0 is taken instead of what P[3] says.
/// Throws InputError that quotes the value and says what to change if P is no rectified pinhole
/// camera, if the two differ in size, focal length or cy, or if the right camera is not to the
/// right of the left one.
StereoCamera toStereoCamera(const sensor_msgs::CameraInfo& left,
                            const sensor_msgs::CameraInfo& right,
                            double baseline_m = 0.0);

/// A sentence on a camera that is possible but unlikely, as one with a baseline in millimetres;
/// empty if there is nothing odd.
std::string oddityOf(const StereoCamera& camera);

}  // namespace rotrocc
