#include "inertial/gyro_predictor.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <opencv2/core.hpp>

#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

/// Growth of the bias's standard deviation [rad/s per sqrt(s)]: that of the cheapest gyroscopes, as
/// a smaller value would not follow them, and a larger one costs little.
constexpr double kWalk = 1e-4;

/// Number of motions in a row after which the opinion changes. One may be wrong in the images.
constexpr int kEnough = 5;

/// Largest usual difference: stamps of the sensors that differ by 10 ms at an angular acceleration
/// of 100 deg/s^2, and axes that are known to 5 degrees.
constexpr double kUsual_rad = 0.02;
constexpr double kUsualShare = 0.1;
constexpr double kSigmas = 3.0;

/// A rotation of this angle shows that the gyroscope is right, if it explains most of it.
constexpr double kInformative_rad = 0.01;
constexpr double kExplained = 0.5;

constexpr double kDegreesPerRadian = 180.0 / M_PI;

/// Noise of the integrated angle [rad per sqrt(s)]: that of the cheapest gyroscopes, because those
/// on robots vibrate.
constexpr double kAngleWalk = 1e-3;

/// The gyroscope moves relative to the camera by more than that from pair to pair. The error of the
/// mount would pass for a bias.
constexpr double kMoving_rad = 1e-3;

}  // namespace

void GyroBias::observe(const Eigen::Vector3d& difference_rad,
                       const Eigen::Matrix3d& by_bias_s,
                       const Eigen::Matrix3d& covariance,
                       double dt_s) {
  covariance_ += kWalk * kWalk * dt_s * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d of_bias = by_bias_s * covariance_ * by_bias_s.transpose();
  const double squared_sigmas =
      difference_rad.dot((of_bias + covariance).llt().solve(difference_rad));
  const double scale = std::max(1.0, squared_sigmas / (kSigmas * kSigmas));
  const Eigen::Matrix3d innovation_covariance = of_bias + scale * covariance;
  // H = -by_bias_s
  const Eigen::Matrix3d gain =
      -innovation_covariance.llt().solve(by_bias_s * covariance_).transpose();
  bias_rps_ += gain * difference_rad;
  const Eigen::Matrix3d kept = Eigen::Matrix3d::Identity() + gain * by_bias_s;
  covariance_ = kept * covariance_ * kept.transpose() +
                scale * gain * covariance * gain.transpose();  // stays symmetric and positive
}

bool GyroTrust::compare(const Comparison& c) {
  const double usual_rad = kUsual_rad + kUsualShare * c.vision_rad + kSigmas * c.uncertainty_rad;
  if (c.difference_rad > usual_rad) {
    agreeing_ = 0;
    ++disagreeing_;
    gyro_rad_ += c.gyro_rad;
    vision_rad_ += c.vision_rad;
    difference_rad_ += c.difference_rad;
    if (disagreeing_ >= kEnough) reject();
    return false;
  }
  disagreeing_ = 0;
  gyro_rad_ = vision_rad_ = difference_rad_ = 0.0;
  if (!why_not_) return true;
  const bool is_informative = c.vision_rad > kInformative_rad;
  if (is_informative && c.difference_rad < kExplained * c.vision_rad) ++agreeing_;
  if (agreeing_ >= kEnough) why_not_.reset();
  return true;
}

void GyroTrust::reject() {
  if (why_not_) return;
  agreeing_ = 0;
  const double ratio = gyro_rad_ / vision_rad_;
  if (ratio > kDegreesPerRadian / 1.5 && ratio < kDegreesPerRadian * 1.5) {
    why_not_ = cv::format(
        "its rotations are %.3g times those of the images: it seems to be in deg/s, but must "
        "be in rad/s",
        ratio);
    return;
  }
  why_not_ = cv::format(
      "its rotations differ from those of the images by %.2g deg per pair: check its stamps, and "
      "the tf from its frame to the camera's, on which roll and pitch of the first pose depend, "
      "too",
      kDegreesPerRadian * difference_rad_ / disagreeing_);
}

void GyroPredictor::add(const GyroSample& sample) {
  if (const auto why = history_.add(sample)) return reject(*why);
  ++counts_.samples;
}

void GyroPredictor::reject(const std::string& why) {
  ++counts_.rejected;
  why_rejected_ = why;
}

void GyroPredictor::miss(const std::string& why) {
  ++counts_.missed;
  why_not_ = why;
  if (why_rejected_) *why_not_ += "; the last sample was rejected: " + *why_rejected_;
}

std::optional<Eigen::Matrix3d> GyroPredictor::rotation(std::int64_t from_ns, std::int64_t to_ns) {
  if (const auto why = trust_.whyNot() ? trust_.whyNot() : history_.whyUnknown(from_ns, to_ns)) {
    miss(*why);
    return std::nullopt;
  }
  why_not_.reset();
  why_rejected_.reset();
  ++counts_.predicted;
  const GyroRotation rotation = history_.rotation(from_ns, to_ns, bias_.bias_rps());
  return R_camera_gyro_from_ * rotation.R_from_to * R_camera_gyro_to_.transpose();
}

void GyroPredictor::observe(const OdometryResult& result) {
  // Its clock was not set with that of the images.
  if (result.clock_set_ns != result.prev_clock_set_ns) return;
  if (result.state != State::kOk) return;
  const std::int64_t from_ns = result.prev_stamp_ns;
  if (history_.whyUnknown(from_ns, result.stamp_ns)) return;
  const GyroRotation gyro = history_.rotation(from_ns, result.stamp_ns, bias_.bias_rps());
  // All in axes of the gyroscope at the current pair.
  const Eigen::Matrix3d seen =
      R_camera_gyro_from_.transpose() * result.T_prev_cur.linear() * R_camera_gyro_to_;
  const Eigen::Vector3d difference_rad = logRotation(gyro.R_from_to.transpose() * seen);
  const Eigen::Matrix3d to_gyro = (R_camera_gyro_from_ * seen).transpose();
  const Eigen::Matrix3d covariance =
      to_gyro * result.covariance.bottomRightCorner<3, 3>() * to_gyro.transpose() +
      kAngleWalk * kAngleWalk * result.dt_s() * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d of_bias = gyro.by_bias_s * bias_.covariance() * gyro.by_bias_s.transpose();
  const bool agrees = trust_.compare({difference_rad.norm(),
                                      std::sqrt((of_bias + covariance).trace()),
                                      gyro.turned_rad,
                                      logRotation(seen).norm()});
  const bool moves =
      logRotation(R_camera_gyro_from_.transpose() * R_camera_gyro_to_).norm() > kMoving_rad;
  if (agrees && moves) return;
  if (agrees) {
    bias_.observe(difference_rad, gyro.by_bias_s, covariance, result.dt_s());
  } else if (trust_.whyNot()) {
    bias_ = GyroBias();  // it may be another one, e.g. after a restart of the device
  }
}

}  // namespace rotrocc
