#pragma once

#include <string>

#include "sequences/image_pairs.h"
#include "sequences/stereo_sequence.h"

namespace rotrocc {

/// Images with the calibration of ROS:
///   left.yaml, right.yaml    files of camera_calibration
///   left/*, right/*          images (png, jpg, bmp, tif, pgm), in the order of their names
///   times.txt                one time [s] per pair; without it, the names of the images are their
///                            times: [ns] without a dot, [s] with one
///   groundtruth.txt          poses of the left camera in TUM format; optional
/// The base is at the left camera, with x forward.
class CalibratedFolder : public StereoSequence {
 public:
  /// Whether `directory` has left and right images, or their calibration.
  static bool isLayoutOf(const std::string& directory);

  /// Throws like openStereoSequence().
  CalibratedFolder(const std::string& directory, const SequenceOptions& options);

  const std::string& directory() const override { return directory_; }
  int size() const override { return pairs_.size(); }
  std::int64_t stamp_ns(int index) const override { return pairs_.stamp_ns(index); }
  StereoPair read(int index) override;
  const StereoCalibration& calibration() const override { return calibration_; }
  const Trajectory& groundTruth() const override { return ground_truth_; }
  Eigen::Isometry3d T_base_camera() const override;
  GyroRecording gyroscope(const std::string& name) const override;
  std::string leftOut() const override { return pairs_.leftOut(); }

 private:
  std::string directory_;
  ImagePairs pairs_;
  StereoCalibration calibration_;
  Trajectory ground_truth_;
};

}  // namespace rotrocc
