#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "motion/motion_solver.h"
#include "motion/reprojection_problem.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {

/// Limit of the reprojection error in stage 1 (Eq. 26), in details of the images: six times the
/// noise of flows on KITTI.
constexpr double kRotationLimit = 0.6;

/// Limit of the DNRE in stage 2 (Eq. 30).
constexpr double kTranslationLimit = 0.04;

/// The paper's b of Eq. 26 and 30: the largest share of the features that an iteration drops. With
/// a larger one, a motion that outliers have bent drops features that fit the right one.
constexpr double kDropShare = 0.15;

/// Safety limit: sets are usually stable after a few iterations.
constexpr int kMaxSelections = 30;

/// Fewer inliers do not determine a motion. The covariance comes from their residuals: with n of
/// them, the variance of the noise is known to sqrt(2 / (2 n - 6)), a fifth for 25.
constexpr int kMinInliers = 25;

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

/// The estimator of section V-B: rotation, flow decoupling, translation; each stage is refined. The
/// result depends only on the arguments.
class TwoStageEstimator {
 public:
  /// Estimates the motion from the features flagged in `set`, starting at `initial`, without
  /// covariance and noise; `problem` becomes that at the motion. The result is invalid if stage 1
  /// leaves fewer than 3 features. If stage 2 leaves fewer than kMinInliers, the motion is that of
  /// stage 1.
  void estimate(const Measurements& measured,
                const FeatureSet& set,
                const Eigen::Isometry3d& initial,
                ReprojectionProblem& problem,
                MotionEstimate& motion);

 private:
  void decouple(const Measurements& measured,
                const ReprojectionProblem& problem,
                const FeatureSet& inliers);
  bool estimateTranslation(const Measurements& measured,
                           ReprojectionProblem& problem,
                           FeatureSet& inliers);
  template <class Measure>
  bool iterate(Unknowns unknowns,
               double limit,
               const Measure& measure,
               ReprojectionProblem& problem,
               FeatureSet& set);

  // Buffers, reused.
  FeatureSet candidates_;
  std::vector<double> errors_, set_errors_, flow_px_;
};

}  // namespace rotrocc
