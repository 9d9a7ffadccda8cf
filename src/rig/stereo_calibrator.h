#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "motion/reprojection_problem.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/rigid_motion.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Rig calibration: estimates the disparity bias, a constant error of all disparities caused by an
/// inexact stereo calibration.
///
/// With biased disparities, no single motion explains both near and far points. The bias is one
/// additional unknown of Eq. 25, estimated with the motion eliminated. Its normal equation is
/// summed over the pairs.
///
/// A real rig also has errors that vary over the image (lens, relative rotation) and shift the
/// estimate by more than its noise. They show as disagreement between parts of the image. The
/// uncertainty is therefore the cluster-robust variance (Liang and Zeger 1986) over a grid of
/// cells.
///
/// A bias below `significance` standard deviations is not corrected; one above twice that is
/// corrected completely.
class StereoCalibrator {
 public:
  using Config = StereoCalibratorConfig;

  explicit StereoCalibrator(const Config& config);

  /// Changes the parameters. The estimate is kept unless the calibration is disabled.
  void configure(const Config& config);

  const DisparityBias& bias() const { return bias_; }

  /// The camera corrected by the applied bias.
  StereoCamera correct(const StereoCamera& camera) const;

  /// Adds a motion estimated from the flagged features. Their depths must be those of `corrected`,
  /// the last result of correct(). If it is called repeatedly for the same pair, only the last call
  /// counts.
  void observe(const StereoCamera& corrected,
               const Correspondences& features,
               const FeatureSet& set,
               const Eigen::Isometry3d& T_keyframe_cur);

  /// Covariance that the uncertainty of the bias adds to that of the last observed motion, in the
  /// order of OdometryResult::covariance.
  Matrix6d motionCovariance() const;

  /// Starts a new pair: the observation of the previous one becomes final.
  void advance();

  /// Discards the estimate, for use with another rig.
  void reset();

 private:
  static constexpr int kColumns = 6;
  static constexpr int kRows = 3;

  /// Normal equations of the bias for each cell of the image: information [1/px^2] * bias =
  /// weighted [1/px].
  struct Evidence {
    std::array<double, kColumns * kRows> information{};
    std::array<double, kColumns * kRows> weighted{};
  };

  /// A feature's residual and its derivatives, and the weight for Newton's method. The derivatives
  /// by the motion have the rotation first, then the translation.
  struct Row {
    std::size_t cell;
    double weight;
    Eigen::Vector2d residual_px;
    Eigen::Vector2d by_bias;
    Eigen::Matrix<double, 2, 6> by_motion;
  };

  void linearise(const StereoCamera& corrected,
                 const Correspondences& features,
                 const FeatureSet& set,
                 const Eigen::Isometry3d& T_keyframe_cur);
  void eliminateMotion();
  void collect();
  void update();

  Config config_;
  Evidence past_, current_;
  DisparityBias bias_;
  Vector6d motion_by_bias_ = Vector6d::Zero();  // translation, then rotation

  // Buffers for one pair, reused.
  Fit fit_;
  ReprojectionProblem<6> problem_;
  std::vector<Row> rows_;
};

}  // namespace rotrocc
