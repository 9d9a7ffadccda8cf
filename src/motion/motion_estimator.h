#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "motion/reprojection_problem.h"
#include "motion/two_stage_estimator.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// The two-stage estimator with extensions beyond the paper: robust refinement of both stages, a
/// retry near the prediction, and the covariance.
class MotionEstimator {
 public:
  virtual ~MotionEstimator() = default;

  /// Estimates the motion that took `dt_s` > 0 from the full feature set, starting at `initial`.
  /// The result is invalid if fewer than 3 features are left, or if the equations have no unique
  /// solution.
  ///
  /// If much of the image moves independently, the full set may give a wrong motion. With few
  /// inliers, it is replaced by the consensus of the full set, if that has more inliers, or by the
  /// motion near `prediction`, if that has more than half as many as the other.
  ///
  /// The result is valid until the next call.
  virtual const MotionEstimate& estimate(
      const StereoCamera& camera,
      const Correspondences& features,
      const Eigen::Isometry3d& initial,
      double dt_s,
      const std::optional<Eigen::Isometry3d>& prediction = std::nullopt);

 protected:
  /// Sets the covariance of a motion, in the order of OdometryResult::covariance, and the noise of
  /// the flow, corrected for the features that stage 1 dropped at `limit_px`. `problem` is at the
  /// motion; weights are those of cauchyWeights() with `robust_factor`, and change. Returns false
  /// if the motion is not valid, or if the features do not determine it.
  ///
  /// The covariance of the rotation comes from stage 1, with the translation marginalized. The
  /// covariance of the translation comes from stage 2, plus the effect of the rotation's error dR:
  ///   dt = -(Jt^T Jt)^-1 Jt^T Jr dR.
  /// Both follow the sandwich formula for robust weights (Huber's M-estimators). Both are inflated,
  /// because neighboring features share errors.
  ///
  /// Stage 1 also drops features that are merely noisy. The remaining errors have only a share g of
  /// the full variance. The covariance of the fit is that of a fit to untruncated errors, divided
  /// by g (the sandwich formula, with both of its parts scaled by g).
  static bool estimateCovariance(const Measurements& measured,
                                 double limit_px,
                                 double robust_factor,
                                 ReprojectionProblem& problem,
                                 MotionEstimate& motion);

 private:
  void takeConsensus(const Measurements& measured);
  void retryNear(const Eigen::Isometry3d& motion, const Measurements& measured);
  void estimateFrom(const FeatureSet& set,
                    const Measurements& measured,
                    const Eigen::Isometry3d& initial,
                    MotionEstimate& estimate);

  TwoStageEstimator two_stages_;

  // Buffers, reused.
  MotionEstimate found_, retry_;
  ReprojectionProblem problem_;
  FeatureSet all_, near_;
  std::vector<double> errors_px_;
};

}  // namespace rotrocc
