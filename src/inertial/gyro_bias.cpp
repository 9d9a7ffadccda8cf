#include "inertial/gyro_bias.h"

#include <algorithm>

#include <Eigen/Cholesky>

namespace rotrocc {
namespace {

/// Growth of the bias's standard deviation [rad/s per sqrt(s)]: that of the cheapest gyroscopes, as
/// a smaller value would not follow them, and a larger one costs little.
constexpr double kWalk = 1e-4;

constexpr double kUsualSigmas = 3.0;

}  // namespace

void GyroBias::observe(const Eigen::Vector3d& difference_rad,
                       const Eigen::Matrix3d& by_bias_s,
                       const Eigen::Matrix3d& covariance,
                       double dt_s) {
  covariance_ += kWalk * kWalk * dt_s * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d of_bias = by_bias_s * covariance_ * by_bias_s.transpose();
  const double squared_sigmas =
      difference_rad.dot((of_bias + covariance).llt().solve(difference_rad));
  const double scale = std::max(1.0, squared_sigmas / (kUsualSigmas * kUsualSigmas));
  const Eigen::Matrix3d innovation_covariance = of_bias + scale * covariance;
  // H = -by_bias_s
  const Eigen::Matrix3d gain =
      -innovation_covariance.llt().solve(by_bias_s * covariance_).transpose();
  bias_rps_ += gain * difference_rad;
  const Eigen::Matrix3d kept = Eigen::Matrix3d::Identity() + gain * by_bias_s;
  covariance_ = kept * covariance_ * kept.transpose() +
                scale * gain * covariance * gain.transpose();  // stays symmetric and positive
}

}  // namespace rotrocc
