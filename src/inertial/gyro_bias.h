#pragma once

#include <Eigen/Core>

namespace rotrocc {

/// Kalman filter of the bias of a gyroscope, in its axes. The bias walks randomly.
class GyroBias {
 public:
  /// Standard deviation before the first observation [rad/s]. Cheap gyroscopes start with biases of
  /// up to 5 deg/s.
  static constexpr double kPriorSigma_rps = 0.1;

  const Eigen::Vector3d& bias_rps() const { return bias_rps_; }
  const Eigen::Matrix3d& covariance() const { return covariance_; }

  /// The measured rotation was R_gyro * Exp(difference_rad), where R_gyro was integrated with
  /// bias_rps(), and by_bias_s is that of GyroRotation. `covariance` is that of the difference,
  /// without the uncertainty of the bias. Differences beyond three standard deviations count as if
  /// they were that uncertain, so that wrong rotations have little influence.
  void observe(const Eigen::Vector3d& difference_rad,
               const Eigen::Matrix3d& by_bias_s,
               const Eigen::Matrix3d& covariance,
               double dt_s);

 private:
  Eigen::Vector3d bias_rps_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_ = kPriorSigma_rps * kPriorSigma_rps * Eigen::Matrix3d::Identity();
};

}  // namespace rotrocc
