#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "check/checked_pair.h"
#include "check/rig_report.h"
#include "check/windows.h"
#include "sequences/stereo_sequence.h"

namespace rotrocc {

/// Compares the rotations of the cameras with those of a gyroscope: the offset between their
/// clocks, the rotation between their axes, and the bias.
class GyroCheck {
 public:
  explicit GyroCheck(GyroRecording gyroscope);

  void observe(const CheckedPair& pair);

  /// Adds to the section time, and the turn rates of both over time.
  void report(const Windows& windows, RigReport& report) const;

 private:
  /// A motion of the camera.
  struct Turn {
    double time_s;
    std::int64_t from_ns, to_ns;
    Eigen::Vector3d camera_rad;  ///< rotation vector, in axes of the camera
  };

  struct Fit {
    double delay_s = 0.0;  ///< to be added to stamps of images to get those of the gyroscope
    Eigen::Matrix3d R_camera_gyro = Eigen::Matrix3d::Identity();
    Eigen::Vector3d bias_rps = Eigen::Vector3d::Zero();  ///< in axes of the gyroscope
    double rms_rad = 0.0;
  };

  std::optional<Eigen::Vector3d> turned(const Turn& turn, double delay_s) const;
  Eigen::Vector3d turnedUpTo(std::int64_t stamp_ns) const;
  Fit fitRotation(double delay_s, const std::vector<Turn>& turns) const;
  Fit fit(const std::vector<Turn>& turns) const;
  void addTable(const Fit& fit, RigReport& report) const;

  std::vector<GyroSample> samples_;
  std::vector<Eigen::Vector3d> sums_rad_;  // integral of the rate up to each sample
  Eigen::Matrix3d R_camera_gyro_;          // as configured
  std::vector<Turn> turns_;
};

}  // namespace rotrocc
