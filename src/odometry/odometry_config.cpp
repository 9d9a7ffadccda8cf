#include "rotrocc/odometry_config.h"

#include <stdexcept>

#include "motion/two_stage_estimator.h"

namespace rotrocc {

const std::vector<std::string>& methodNames() {
  static const std::vector<std::string> names = {"default", "paper"};
  return names;
}

Matrix6d SystematicErrorConfig::covarianceOf(const Eigen::Isometry3d& motion) const {
  const double translation_m = translation_share * motion.translation().norm();
  const double rotation_rad = rotation_share * logRotation(motion.linear()).norm();
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(translation_m), Eigen::Vector3d::Constant(rotation_rad);
  return sigma.cwiseAbs2().asDiagonal();
}

void OdometryConfig::check() const {
  criterionOf(motion_estimator.criterion);
  if (method != "default" && method != "paper") {
    throw std::invalid_argument("method is \"" + method + "\", but must be default or paper");
  }
}

void useMethodOfPaper(OdometryConfig& config) {
  // Section V-A: plain Lucas-Kanade, without tracking back.
  FeatureTrackerConfig& tracker = config.correspondence_finder.feature_tracker;
  tracker.max_round_trip_px = 0.0;
  tracker.scale_windows = false;
  tracker.ignore_brightness = false;
  // Eq. 25 and 29: equal weights for all residuals.
  MotionEstimatorConfig& estimator = config.motion_estimator;
  estimator.noise_ratio = 0.0;
  estimator.shared_ratio = 0.0;
  estimator.robust_factor = 0.0;
  // Section V-B: both stages start from the full feature set and the prediction, without a retry.
  estimator.retry_agreement_px = 0.0;
  estimator.translation_noise_factor = 0.0;
  estimator.translation_initial_px = 0.0;
  estimator.translation_from_prediction = true;
  // Motions are from pair to pair.
  config.keep_keyframe = false;
}

}  // namespace rotrocc
