#pragma once

#include "rotrocc/kitti.h"
#include "sequences/stereo_sequence.h"

namespace rotrocc {

/// KittiSequence with KITTI's mount, and the gyroscope of imu.csv in axes of the left camera, as
/// simulate_drive --imu writes it.
class KittiLayout : public StereoSequence {
 public:
  /// Throws like KittiSequence.
  explicit KittiLayout(const std::string& directory, bool being_written = false);

  const std::string& directory() const override { return sequence_.directory(); }
  int size() const override { return sequence_.size(); }
  std::int64_t stamp_ns(int index) const override { return sequence_.stamp_ns(index); }
  bool hasPair(int index) const override { return sequence_.hasPair(index); }
  StereoPair read(int index) override;
  const StereoCalibration& calibration() const override { return calibration_; }
  const Trajectory& groundTruth() const override { return sequence_.groundTruth(); }
  Eigen::Isometry3d T_base_camera() const override;
  GyroRecording gyroscope(const std::string& name) const override;
  std::string leftOut() const override { return ""; }

 private:
  KittiSequence sequence_;
  StereoCalibration calibration_;
};

}  // namespace rotrocc
