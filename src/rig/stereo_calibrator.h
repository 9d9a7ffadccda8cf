#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "motion/reprojection_problem.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/rigid_motion.h"
#include "rotrocc/stereo_camera.h"

#include "rotrocc/odometry_result.h"

namespace rotrocc {

/// Finds the constant error that a rig, not quite as its calibration says, has in all its
/// disparities.
///
/// A wrong disparity puts near and far points to depths that no one motion explains: the bias is
/// the one more unknown of Eq. 25 that makes them consistent, with the motion eliminated. Its
/// normal equation is summed over the pairs. A real rig also has errors that differ over the image
/// (lens, relative rotation) and push the estimate by more than its noise. They show as parts of
/// the image that disagree with each other, so the uncertainty is taken from those: the
/// cluster-robust variance (Liang and Zeger 1986) over a grid of cells. What is within the
/// doubt, a multiple of it, is not applied, and what is well beyond is applied whole.
class StereoCalibrator {
 public:
  using Config = StereoCalibratorConfig;

  explicit StereoCalibrator(const Config& config);

  /// Takes other parameters. What was observed stays, unless observing is at an end.
  void configure(const Config& config);

  const DisparityBias& bias() const { return bias_; }

  /// The camera whose depths have the bias taken out.
  StereoCamera correct(const StereoCamera& camera) const;

  /// Takes a motion estimated from the flagged features, whose depths are those of `corrected`, as
  /// correct() gave it last. Called again for the same pair, the last call counts.
  void observe(const StereoCamera& corrected,
               const Correspondences& features,
               const FeatureSet& set,
               const Eigen::Isometry3d& T_prev_cur);

  /// Covariance that the doubt about the bias adds to that of the motion observed last, in the
  /// order of OdometryResult::covariance.
  Matrix6d motionCovariance() const;

  /// What was observed since the last call is of an earlier pair.
  void advance();

  /// Forgets everything: the rig is another one.
  void reset();

 private:
  static constexpr int kColumns = 6;
  static constexpr int kRows = 3;

  /// Normal equations of the bias, by cell of the image: information * bias = weighted [1/px^2,
  /// 1/px].
  struct Evidence {
    std::array<double, kColumns * kRows> information{};
    std::array<double, kColumns * kRows> weighted{};
  };

  /// A feature's residual and derivatives, weighted for Newton's method: those by the motion have
  /// the translation last.
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
                 const Eigen::Isometry3d& T_prev_cur);
  void eliminateMotion();
  void collect();
  void update();

  Config config_;
  Evidence past_, current_;
  DisparityBias bias_;
  Vector6d motion_by_bias_ = Vector6d::Zero();  // translation, then rotation

  // Of the pair; reused.
  Fit fit_;
  ReprojectionProblem<6> problem_;
  std::vector<Row> rows_;
};

}  // namespace rotrocc
