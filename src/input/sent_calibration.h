#pragma once

#include <string>

#include <sensor_msgs/CameraInfo.h>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// What K and P of a camera_info with binning or a region of interest refer to.
/// sensor_msgs/CameraInfo says the whole image before binning, but some drivers fill in those of
/// the image that they send.
struct CalibratedImage {
  bool is_binned = false;
  bool is_cropped = false;
};

/// Finds it by the principal point, which is near the middle of the whole image: the convention of
/// sensor_msgs/CameraInfo unless that puts it clearly farther from there than another one.
CalibratedImage calibratedImageOf(const sensor_msgs::CameraInfo& info);

/// Whether a region of interest leaves a part of the whole image.
bool isCropped(const sensor_msgs::CameraInfo& info);

/// The sizes, K and P of the images as they are sent: without binning and region of interest.
sensor_msgs::CameraInfo ofSentImages(sensor_msgs::CameraInfo info, const CalibratedImage& of);

/// Throws InputError with the value and a remedy if a principal point does not belong to an image
/// of this size, which is not cropped: it is outside, or off the middle like that of the same image
/// at another size. `matrix` has it, as "P of the left camera_info".
void requireOfItsImage(const std::string& matrix,
                       double cx,
                       double cy,
                       const sensor_msgs::CameraInfo& sent);

/// What is implausible about the stereo camera of the left `info`, with a remedy: principal
/// point, angle of view, shape of the pixels, binning and region of interest; empty if nothing is.
std::string calibrationWarning(const sensor_msgs::CameraInfo& info, const StereoCamera& camera);

/// Why a baseline may be in another unit; empty if its size is usual. An endoscope has an unusual
/// one.
std::string baselineWarning(double baseline_m);

}  // namespace rotrocc
