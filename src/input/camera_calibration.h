#pragma once

#include <string>
#include <utility>

#include <sensor_msgs/CameraInfo.h>

#include "rectification/stereo_calibration.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// The stereo camera that the projection matrices P of two rectified cameras describe. K, D and R
/// are ignored: they belong to the images before rectification. A non-zero P[3] of the left camera,
/// as for KITTI's color cameras, is subtracted from the baseline. As in
/// image_geometry, the offset of roi is subtracted from the principal point before dividing by the
/// binning, unless calibratedImageOf() finds another convention. `baseline_m` > 0 replaces the
/// baseline from P[3]. Throws InputError with the value and a remedy if P is not a rectified
/// pinhole camera or not of its image, see requireOfItsImage(), if the two differ in size, focal
/// length or cy, or if the right camera is not to the right of the left one.
StereoCamera toStereoCamera(const sensor_msgs::CameraInfo& left,
                            const sensor_msgs::CameraInfo& right,
                            double baseline_m = 0.0);

/// What K, D, R and P of two messages describe, with binning and region of interest
/// as in toStereoCamera(). `baseline_m` > 0 replaces the baseline from P[3]. Throws InputError with
/// the value and a remedy if P is not that of a rectified pair (see toStereoCamera()), K is not a
/// pinhole camera of its image, or D or R are invalid.
StereoCalibration toStereoCalibration(const sensor_msgs::CameraInfo& left,
                                      const sensor_msgs::CameraInfo& right,
                                      double baseline_m = 0.0);

/// Whether two messages describe images that must be rectified. Invalid ones do, so that the
/// rectification reports what is wrong; those without K do not.
bool describeRawImages(const sensor_msgs::CameraInfo& left,
                       const sensor_msgs::CameraInfo& right,
                       double baseline_m = 0.0);

/// Whether images are rectified by the name of their topic, whatever its camera_info says: that of
/// image_proc is of the raw images. The last part is image_rect, image_rect_color and the like, or
/// it is a topic of kitti2bag, whose image_raw is rectified.
bool isRectifiedByName(std::string image_topic);

/// The left and right messages from which toStereoCalibration() makes this calibration, without
/// headers.
std::pair<sensor_msgs::CameraInfo, sensor_msgs::CameraInfo> toCameraInfos(
    const StereoCalibration& calibration);

/// Whether two messages describe the same camera, up to what no pixel shows.
bool isSameCamera(const sensor_msgs::CameraInfo& a, const sensor_msgs::CameraInfo& b);

}  // namespace rotrocc
