#pragma once

#include <string>

#include "sequences/image_pairs.h"
#include "sequences/stereo_sequence.h"

namespace rotrocc {

/// A recording in ASL format, as those of EuRoC:
///   mav0/cam0/data.csv, sensor.yaml, data/*.png    left camera: stamps [ns] and file names,
///                                                  intrinsics, distortion and pose on the body
///   mav0/cam1/...                                  right camera
///   mav0/imu0/data.csv, sensor.yaml                gyroscope and its pose; optional
///   mav0/state_groundtruth_estimate0/data.csv      poses of the body (position, quaternion w x y
///                                                  z), and the body's pose in sensor.yaml;
///                                                  optional
/// The base is the body. The pairs are rectified as chooseRectification() says.
class AslSequence : public StereoSequence {
 public:
  /// Whether `directory`, or mav0 in it, has a cam0.
  static bool isLayoutOf(const std::string& directory);

  /// Throws like openStereoSequence().
  AslSequence(const std::string& directory, const SequenceOptions& options);

  const std::string& directory() const override { return directory_; }
  int size() const override { return pairs_.size(); }
  std::int64_t stamp_ns(int index) const override { return pairs_.stamp_ns(index); }
  StereoPair read(int index) override;
  const StereoCalibration& calibration() const override { return calibration_; }
  const Trajectory& groundTruth() const override { return ground_truth_; }
  Eigen::Isometry3d T_base_camera() const override { return T_body_camera_; }
  GyroRecording gyroscope(const std::string& name) const override;
  std::string leftOut() const override { return pairs_.leftOut(); }

 private:
  std::string directory_;
  std::string root_;  // mav0
  ImagePairs pairs_;
  StereoCalibration calibration_;
  Eigen::Isometry3d T_body_camera_;  // of the left rectified camera
  Trajectory ground_truth_;
};

}  // namespace rotrocc
