#pragma once

#include <memory>

#include <sensor_msgs/CameraInfo.h>

#include "rectification/stereo_calibration.h"

namespace rotrocc {

/// What K, D, R and P of two messages describe, with binning and region of interest as in
/// image_geometry. `baseline_m` > 0 replaces the baseline from P[3]. Throws InputError with the
/// value and a remedy if P is not that of a rectified pair (see toStereoCamera()), K is not a
/// pinhole camera, or D or R are invalid.
StereoCalibration toStereoCalibration(const sensor_msgs::CameraInfo& left,
                                      const sensor_msgs::CameraInfo& right,
                                      double baseline_m = 0.0);

/// Whether K, D and R describe images that are not rectified.
bool describesRawImages(const sensor_msgs::CameraInfo& info);

/// The calibration of the latest messages. Cameras send them with each image, but hardly ever
/// change.
class CurrentCalibration {
 public:
  explicit CurrentCalibration(double baseline_m) : baseline_m_(baseline_m) {}

  /// The same object as long as the messages describe the same cameras. Throws as
  /// toStereoCalibration().
  const std::shared_ptr<const StereoCalibration>& of(
      const sensor_msgs::CameraInfo::ConstPtr& left,
      const sensor_msgs::CameraInfo::ConstPtr& right);

 private:
  double baseline_m_;
  std::shared_ptr<const StereoCalibration> calibration_;
  // The messages that it is made of.
  sensor_msgs::CameraInfo::ConstPtr left_;
  sensor_msgs::CameraInfo::ConstPtr right_;
};

}  // namespace rotrocc
