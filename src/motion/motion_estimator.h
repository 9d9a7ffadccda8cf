#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "motion/motion_solver.h"
#include "motion/outlier_rejection.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Which features may estimate the motion.
enum class Criterion {
  kRotrocc,       ///< reprojection error for rotation, then DNRE for translation (section V-B)
  kReprojection,  ///< reprojection error alone: stage 1 and no more
  kRocc,          ///< as kRotrocc, but normalized by the coupled flow (ROCC, Eq. 8)
  kMeanBased,     ///< one stage, Eq. 32
  kStdBased       ///< one stage, Eq. 31
};

/// "rotrocc", "reprojection", "rocc", "mean_based", "std_based".
const std::vector<std::string>& criterionNames();

/// The two-stage estimator: rotation, flow decoupling, translation (section V-B).
class MotionEstimator {
 public:
  using Config = MotionEstimatorConfig;

  struct Estimate {
    bool valid = false;
    Eigen::Isometry3d T_prev_cur = Eigen::Isometry3d::Identity();
    Matrix6d covariance = Matrix6d::Zero();  ///< as OdometryResult::covariance
    FeatureSet rotation_inliers;
    FeatureSet translation_inliers;
    bool has_translation_stage = false;
  };

  /// Throws std::invalid_argument on a criterion of another name.
  explicit MotionEstimator(const Config& config);

  /// From now on; better known than to begin with.
  void setNoiseRatio(double noise_ratio);

  /// Estimates the motion that took `dt_s` > 0 from the full feature set, beginning with `initial`.
  /// Invalid if fewer than 3 features are left, or the equations have no unique solution.
  ///
  /// Where much of the image moves by itself, the full set may lead astray. If few features agree
  /// with the motion found and `initial` is a prediction, the features near to it are tried too; of
  /// two motions that many features agree with, the likelier one is that nearer to the prediction.
  /// What is returned is the estimator's own, until the next call.
  const Estimate& estimate(const StereoCamera& camera,
                           const Correspondences& features,
                           const Eigen::Isometry3d& initial,
                           double dt_s,
                           bool is_prediction = true);

 private:
  void estimateFrom(const FeatureSet& set,
                    const StereoCamera& camera,
                    const Correspondences& features,
                    const Eigen::Isometry3d& initial,
                    double dt_s,
                    Estimate& estimate);
  bool estimateRotation(Estimate& estimate);
  bool estimateTranslation(const StereoCamera& camera,
                           const Correspondences& features,
                           Estimate& estimate);
  /// Fits a motion to the set and draws the line anew, until the set stays (Eq. 26, 30, 31, 32);
  /// then, with robust weights, a few times more. `fit` returns false if it fails; `measure` fills
  /// errors_.
  template <class Fit, class Measure>
  bool iterate(OutlierThreshold& threshold,
               int max_iterations,
               const Fit& fit,
               const Measure& measure,
               FeatureSet& set);
  bool estimateCovariance(Estimate& estimate);

  Config config_;
  Criterion criterion_;
  MotionSolver solver_;
  OutlierThreshold rotation_threshold_;
  OutlierThreshold translation_threshold_;

  // Kept for their memory.
  Estimate found_, other_;
  FeatureSet all_, near_, candidates_, next_;
  std::vector<double> errors_;
  std::vector<double> flow_px_;
};

}  // namespace rotrocc
