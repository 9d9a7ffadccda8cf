#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "motion/reprojection_problem.h"
#include "motion/two_stage_estimator.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// The two-stage estimator with extensions beyond the paper: robust refinement of both stages, a
/// retry near the prediction, and the covariance.
class MotionEstimator {
 public:
  using Config = MotionEstimatorConfig;

  /// Throws std::invalid_argument on an unknown criterion.
  explicit MotionEstimator(const Config& config);

  /// Estimates the motion that took `dt_s` > 0 from the full feature set, starting at `initial`.
  /// The result is invalid if fewer than 3 features are left, or if the equations have no unique
  /// solution.
  ///
  /// If much of the image moves independently, the full set may give a wrong motion. With few
  /// inliers, it is replaced by the consensus of the full set, if that has more inliers, or by the
  /// motion near `prediction`, if that has more than half as many as the other.
  ///
  /// The result is valid until the next call.
  const MotionEstimate& estimate(const StereoCamera& camera,
                                 const Correspondences& features,
                                 const Eigen::Isometry3d& initial,
                                 double dt_s,
                                 const std::optional<Eigen::Isometry3d>& prediction = std::nullopt);

 private:
  void takeConsensus(const Measurements& measured, double dt_s);
  void retryNear(const Eigen::Isometry3d& motion, const Measurements& measured, double dt_s);
  void estimateFrom(const FeatureSet& set,
                    const Measurements& measured,
                    const Eigen::Isometry3d& initial,
                    double dt_s,
                    MotionEstimate& estimate);

  Config config_;
  TwoStageEstimator two_stages_;

  // Buffers, reused.
  MotionEstimate found_, retry_;
  ReprojectionProblem problem_;
  FeatureSet all_, near_;
  std::vector<double> errors_px_;
};

}  // namespace rotrocc
