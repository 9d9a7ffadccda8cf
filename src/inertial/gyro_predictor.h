#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "inertial/gyro_bias.h"
#include "inertial/gyro_history.h"
#include "inertial/gyro_trust.h"
#include "rotrocc/odometry_result.h"

namespace rotrocc {

/// Predicts rotations of a camera from a gyroscope on the same robot. Learns the bias of the
/// gyroscope from the motions of the odometry, while it does not move relative to the camera.
class GyroPredictor {
 public:
  struct Counts {
    std::uint64_t samples = 0;    ///< without the refused ones
    std::uint64_t refused = 0;    ///< samples
    std::uint64_t predicted = 0;  ///< rotations
    std::uint64_t missed = 0;     ///< rotations that were not predicted
  };

  explicit GyroPredictor(const Eigen::Matrix3d& R_camera_gyro = Eigen::Matrix3d::Identity())
      : R_camera_gyro_from_(R_camera_gyro), R_camera_gyro_to_(R_camera_gyro) {}

  /// At the beginning and at the end of the rotations that are asked for and observed from now on.
  void setMount(const Eigen::Matrix3d& R_camera_gyro_from,
                const Eigen::Matrix3d& R_camera_gyro_to) {
    R_camera_gyro_from_ = R_camera_gyro_from;
    R_camera_gyro_to_ = R_camera_gyro_to;
  }

  /// Samples that are no numbers or out of order are refused.
  void add(const GyroSample& sample);
  /// Counts a sample that was refused before, for the reason of a sentence.
  void refuse(const std::string& why);

  const GyroHistory& history() const { return history_; }

  /// R_from_to of the camera. Nothing if samples are missing or the gyroscope is not trusted;
  /// whyNot() has the reason.
  std::optional<Eigen::Matrix3d> rotation(std::int64_t from_ns, std::int64_t to_ns);
  /// Counts a rotation that cannot be asked for, for the reason of a sentence.
  void miss(const std::string& why);

  /// To be called with the result of each pair.
  void observe(const OdometryResult& result);

  /// Why the last rotation was not predicted, in a sentence or two; none if it was.
  const std::optional<std::string>& whyNot() const { return why_not_; }

  /// Why the gyroscope is not trusted, see GyroTrust; none if it is.
  const std::optional<std::string>& whyDistrusted() const { return trust_.whyNot(); }

  const GyroBias& bias() const { return bias_; }
  const Counts& counts() const { return counts_; }

 private:
  Eigen::Matrix3d R_camera_gyro_from_, R_camera_gyro_to_;
  GyroHistory history_;
  GyroBias bias_;
  GyroTrust trust_;
  Counts counts_;
  std::optional<std::string> why_not_;
  std::optional<std::string> why_refused_;  // the last sample, since the last predicted rotation
};

}  // namespace rotrocc
