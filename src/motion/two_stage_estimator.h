#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "motion/motion_solver.h"
#include "motion/reprojection_problem.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {

/// The criterion that selects inliers, see criterionNames().
enum class Criterion { kRotrocc, kReprojection, kRocc, kMeanBased, kStdBased };

/// The criterion of that name. Throws std::invalid_argument on any other name.
Criterion criterionOf(const std::string& name);

/// Limit of the reprojection error in stage 1 (Eq. 26), in details of the images: six times the
/// noise of flows on KITTI.
constexpr double kRotationLimit = 0.6;

/// Fewer inliers do not determine a motion. The covariance comes from their residuals: with n of
/// them, the variance of the noise is known to sqrt(2 / (2 n - 6)), a fifth for 25.
constexpr int kMinInliers = 25;

/// Whether the criterion has a fixed limit of the reprojection error in stage 1.
constexpr bool hasFixedLimit(Criterion criterion) {
  return criterion != Criterion::kMeanBased && criterion != Criterion::kStdBased;
}

/// A motion, and what it was estimated from.
struct MotionEstimate {
  bool valid = false;
  Eigen::Isometry3d T_keyframe_cur = Eigen::Isometry3d::Identity();
  FeatureSet rotation_inliers;
  FeatureSet translation_inliers;  ///< equal to rotation_inliers without a stage 2
  bool has_translation_stage = false;
  bool translation_failed = false;         ///< stage 2 failed: the motion is that of stage 1
  Matrix6d covariance = Matrix6d::Zero();  ///< as OdometryResult::covariance
  double flow_noise_px = 0.0;              ///< standard deviation in x and y, from the inliers
};

/// The estimator of section V-B: rotation, flow decoupling, translation. Alternatively one of the
/// criteria that the paper compares it with. The result depends only on the arguments.
class TwoStageEstimator {
 public:
  /// Throws std::invalid_argument on an unknown criterion.
  explicit TwoStageEstimator(const MotionEstimatorConfig& config);

  /// Estimates the motion that took `dt_s` > 0 from the features flagged in `set`, starting at
  /// `initial`, without covariance and noise; `problem` becomes that at the motion. The result is
  /// invalid if stage 1 leaves fewer than 3 features. If stage 2 leaves fewer than kMinInliers,
  /// the motion is that of stage 1. Each stage is refined, but not as published.
  void estimate(const Measurements& measured,
                const FeatureSet& set,
                const Eigen::Isometry3d& initial,
                double dt_s,
                ReprojectionProblem& problem,
                MotionEstimate& motion);

 private:
  bool estimateRotation(double detail_px, ReprojectionProblem& problem, FeatureSet& inliers);
  void decouple(const Measurements& measured,
                const ReprojectionProblem& problem,
                const FeatureSet& inliers);
  void selectCandidates(const Measurements& measured, const ReprojectionProblem& problem);
  bool estimateTranslation(const Measurements& measured,
                           ReprojectionProblem& problem,
                           FeatureSet& inliers);
  template <class Measure, class Threshold>
  bool iterate(int max_iterations,
               Unknowns unknowns,
               ReprojectionProblem& problem,
               const Measure& measure,
               const Threshold& threshold,
               FeatureSet& set);

  MotionEstimatorConfig config_;
  Criterion criterion_;

  // Buffers, reused.
  FeatureSet candidates_, next_;
  std::vector<double> errors_, set_errors_;
  std::vector<double> flow_px_;
};

}  // namespace rotrocc
