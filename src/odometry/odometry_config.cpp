#include "rotrocc/odometry_config.h"

#include <algorithm>
#include <stdexcept>

#include <boost/algorithm/string/join.hpp>

namespace rotrocc {
namespace {

void requireOneOf(const std::vector<std::string>& names,
                  const std::string& parameter,
                  const std::string& value) {
  if (std::find(names.begin(), names.end(), value) != names.end()) return;
  throw std::invalid_argument(parameter + " is \"" + value + "\", but must be one of " +
                              boost::join(names, ", "));
}

}  // namespace

const std::vector<std::string>& criterionNames() {
  static const std::vector<std::string> names = {
      "rotrocc", "reprojection", "rocc", "mean_based", "std_based"};
  return names;
}

const std::vector<std::string>& methodNames() {
  static const std::vector<std::string> names = {"default", "paper"};
  return names;
}

Matrix6d SystematicErrorConfig::covarianceOf(const Eigen::Isometry3d& motion) const {
  // Axes turned by e see the translation t + e x t and the rotation Exp(e) R Exp(-e). Real errors
  // of the two are not correlated as by the same e.
  const auto covariance = [&](const Eigen::Matrix3d& by_axes, const Eigen::Vector3d& by_scale) {
    return Eigen::Matrix3d(axes_rad * axes_rad * by_axes * by_axes.transpose() +
                           scale_share * scale_share * by_scale * by_scale.transpose());
  };
  const Eigen::Matrix3d R = motion.linear();
  Matrix6d both = Matrix6d::Zero();
  both.topLeftCorner<3, 3>() = covariance(skew(motion.translation()), motion.translation());
  both.bottomRightCorner<3, 3>() = covariance(Eigen::Matrix3d::Identity() - R, logRotation(R));
  return both;
}

void OdometryConfig::check() const {
  requireOneOf(methodNames(), "method", method);
  requireOneOf(criterionNames(), "criterion", motion_estimator.criterion);
  if (!isPaper() && motion_estimator.criterion != "rotrocc") {
    throw std::invalid_argument("criterion is \"" + motion_estimator.criterion +
                                "\", but must be rotrocc unless method is paper");
  }
}

}  // namespace rotrocc
