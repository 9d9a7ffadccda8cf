#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "inertial/gyro_history.h"
#include "rotrocc/odometry_result.h"

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

/// Whether the rotations of a gyroscope agree with those of the images.
class GyroTrust {
 public:
  /// Angles of one motion [rad].
  struct Comparison {
    double difference_rad;   ///< between the two rotations
    double uncertainty_rad;  ///< standard deviation of this difference
    double gyro_rad;         ///< all angles of the gyroscope added up
    double vision_rad;
  };

  /// Whether the two rotations agree, up to what is usual.
  bool compare(const Comparison& comparison);

  /// Why the gyroscope is not to be used, in one sentence with a remedy; none if it is.
  const std::optional<std::string>& whyNot() const { return why_not_; }

 private:
  void reject();

  int disagreeing_ = 0;  // in a row
  int agreeing_ = 0;     // in a row, since it was rejected
  double gyro_rad_ = 0.0, vision_rad_ = 0.0, difference_rad_ = 0.0;  // of the disagreeing ones
  std::optional<std::string> why_not_;
};

/// Predicts rotations of a camera from a gyroscope on the same robot. Learns the bias of the
/// gyroscope from the motions of the odometry, while it does not move relative to the camera.
class GyroPredictor {
 public:
  struct Counts {
    std::uint64_t samples = 0;    ///< without the rejected ones
    std::uint64_t rejected = 0;   ///< samples
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

  /// Samples that are no numbers or out of order are rejected.
  void add(const GyroSample& sample);
  /// Counts a sample that was rejected before, for the reason of a sentence.
  void reject(const std::string& why);

  const GyroHistory& history() const { return history_; }

  /// R_from_to of the camera. Nothing if samples are missing or the gyroscope is not trusted;
  /// whyNot() has the reason.
  std::optional<Eigen::Matrix3d> rotation(std::int64_t from_ns, std::int64_t to_ns);
  /// Counts a rotation that cannot be asked for, for the reason of a sentence.
  void miss(const std::string& why);

  /// Call with the result of each pair.
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
  std::optional<std::string> why_rejected_;  // the last sample, since the last predicted rotation
};

}  // namespace rotrocc
