#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "rotrocc/cauchy_weights.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/reprojection_error.h"
#include "rotrocc/rigid_motion.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// What is known of the bias of the disparities.
struct DisparityBias {
  double estimated_px = 0.0;  ///< to be added to every disparity
  double sigma_px = 0.0;      ///< standard deviation of the estimate
  double applied_px = 0.0;    ///< the part of it beyond doubt, which is added
};

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
  struct Config {
    bool enabled = true;   ///< if not, bias_px is all that is applied
    double bias_px = 0.0;  ///< known already, added to every disparity; the estimate begins there
    double prior_sigma_px = 1.0;  ///< how far from bias_px a rig may be expected to be
    double memory_pairs = 100.0;  ///< a pair's weight falls by 1/e over as many that tell as much
    double significance = 3.0;    ///< standard deviations that count as doubt
    /// What matching may be off by in the whole image alike, which no comparison within it shows:
    /// windows at edges see what is nearer, too. Part of the uncertainty.
    double matching_sigma_px = 0.01;
    /// Disparity noise over flow noise, see fitDisparities(). Less than what is measured: fitted
    /// disparities also follow errors that neighbours share, and take the estimate with them.
    double noise_ratio = 0.5;
    double robust_factor = 2.0;  ///< of CauchyWeights; 0: all residuals count alike
  };

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

  void linearise(const StereoCamera& corrected,
                 const Correspondences& features,
                 const FeatureSet& set,
                 const Eigen::Isometry3d& T_prev_cur);
  void eliminateMotion();
  void collect(const StereoCamera& corrected,
               const Correspondences& features,
               const FeatureSet& set);
  void update();

  Config config_;
  Evidence past_, current_;
  DisparityBias bias_;
  Vector6d motion_by_bias_ = Vector6d::Zero();  // translation, then rotation

  // Of the pair: buffers that are used again, and how they are seen.
  using Column = Eigen::Map<Eigen::VectorXd>;
  using Columns = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 6>>;
  Column residuals() { return {residuals_.data(), problem_.residualCount()}; }
  Column byBias() { return {by_bias_.data(), problem_.residualCount()}; }
  Columns byMotion() { return {by_motion_.data(), problem_.residualCount(), 6}; }
  ReprojectionProblem<6> problem_;
  CauchyWeights weights_;
  std::vector<double> residuals_, by_bias_, by_motion_;
};

}  // namespace rotrocc
