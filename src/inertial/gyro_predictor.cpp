#include "inertial/gyro_predictor.h"

#include <cmath>

#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

/// Noise of the integrated angle [rad per sqrt(s)]: that of the cheapest gyroscopes, because those
/// on robots vibrate.
constexpr double kAngleWalk = 1e-3;

/// The gyroscope moves relative to the camera by more than that from pair to pair. The error of the
/// mount would pass for a bias.
constexpr double kMoving_rad = 1e-3;

}  // namespace

void GyroPredictor::add(const GyroSample& sample) {
  if (const auto why = history_.add(sample)) return refuse(*why);
  ++counts_.samples;
}

void GyroPredictor::refuse(const std::string& why) {
  ++counts_.refused;
  why_refused_ = why;
}

void GyroPredictor::miss(const std::string& why) {
  ++counts_.missed;
  why_not_ = why;
  if (why_refused_) *why_not_ += "; the last sample was refused: " + *why_refused_;
}

std::optional<Eigen::Matrix3d> GyroPredictor::rotation(std::int64_t from_ns, std::int64_t to_ns) {
  if (const auto why = trust_.whyNot() ? trust_.whyNot() : history_.whyUnknown(from_ns, to_ns)) {
    miss(*why);
    return std::nullopt;
  }
  why_not_.reset();
  why_refused_.reset();
  ++counts_.predicted;
  const GyroRotation rotation = history_.rotation(from_ns, to_ns, bias_.bias_rps());
  return R_camera_gyro_from_ * rotation.R_from_to * R_camera_gyro_to_.transpose();
}

void GyroPredictor::observe(const OdometryResult& result) {
  if (result.state != State::kOk) return;
  const std::int64_t from_ns = result.stamp_ns - std::llround(1e9 * result.dt_s);
  if (history_.whyUnknown(from_ns, result.stamp_ns)) return;
  const GyroRotation gyro = history_.rotation(from_ns, result.stamp_ns, bias_.bias_rps());
  // All in axes of the gyroscope at the current pair.
  const Eigen::Matrix3d seen =
      R_camera_gyro_from_.transpose() * result.T_prev_cur.linear() * R_camera_gyro_to_;
  const Eigen::Vector3d difference_rad = logRotation(gyro.R_from_to.transpose() * seen);
  const Eigen::Matrix3d to_gyro = (R_camera_gyro_from_ * seen).transpose();
  const Eigen::Matrix3d covariance =
      to_gyro * result.covariance.bottomRightCorner<3, 3>() * to_gyro.transpose() +
      kAngleWalk * kAngleWalk * result.dt_s * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d of_bias = gyro.by_bias_s * bias_.covariance() * gyro.by_bias_s.transpose();
  const bool agrees = trust_.compare({difference_rad.norm(),
                                      std::sqrt((of_bias + covariance).trace()),
                                      gyro.turned_rad,
                                      logRotation(seen).norm()});
  const bool moves =
      logRotation(R_camera_gyro_from_.transpose() * R_camera_gyro_to_).norm() > kMoving_rad;
  if (agrees && moves) return;
  if (agrees) {
    bias_.observe(difference_rad, gyro.by_bias_s, covariance, result.dt_s);
  } else if (trust_.whyNot()) {
    bias_ = GyroBias();  // it may be another one, e.g. after a restart of the device
  }
}

}  // namespace rotrocc
