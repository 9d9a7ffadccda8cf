#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "motion/criterion.h"
#include "motion/fitted_feature.h"
#include "motion/motion_solver.h"
#include "motion/outlier_rejection.h"
#include "motion/robust_refinement.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

/// The result of the two stages.
struct TwoStageMotion {
  bool valid = false;
  Fit fit;  ///< the motion and the features fitted at it
  FeatureSet rotation_inliers;
  FeatureSet translation_inliers;  ///< equal to rotation_inliers without a stage 2
  bool has_translation_stage = false;
  bool translation_failed = false;  ///< stage 2 failed: the motion is that of stage 1
};

/// The estimator of section V-B: rotation, flow decoupling, translation. Alternatively one of the
/// criteria that the paper compares it with. The result depends only on the arguments.
class TwoStageEstimator {
 public:
  /// Throws std::invalid_argument on an unknown criterion.
  explicit TwoStageEstimator(const MotionEstimatorConfig& config);

  /// Estimates the motion that took `dt_s` > 0 from the features flagged in `set`, starting at
  /// `initial`. The result is invalid if stage 1 leaves fewer than 3 features. If stage 2 leaves
  /// fewer than `min_inliers`, the motion is that of stage 1. `refinement`, if given, is applied
  /// after each stage.
  void estimate(const Measurements& measured,
                const FeatureSet& set,
                const Eigen::Isometry3d& initial,
                double dt_s,
                int min_inliers,
                RobustRefinement* refinement,
                TwoStageMotion& motion);

 private:
  bool estimateRotation(const Measurements& measured,
                        RobustRefinement* refinement,
                        TwoStageMotion& motion);
  void decouple(const Measurements& measured, const TwoStageMotion& stage_one);
  double flowNoise(const Measurements& measured, const TwoStageMotion& stage_one);
  void selectCandidates(const Measurements& measured, const Fit& fit);
  bool estimateTranslation(const Measurements& measured,
                           RobustRefinement* refinement,
                           TwoStageMotion& motion);
  template <class Solve, class Measure>
  bool iterate(OutlierThreshold& threshold,
               int max_iterations,
               const Solve& solve,
               const Measure& measure,
               FeatureSet& set);

  MotionEstimatorConfig config_;
  Criterion criterion_;
  MotionSolver solver_;
  OutlierThreshold rotation_threshold_;
  OutlierThreshold translation_threshold_;

  // Buffers, reused.
  FeatureSet candidates_, next_;
  std::vector<double> errors_, inlier_errors_px_;
  std::vector<double> flow_px_;
};

}  // namespace rotrocc
