#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "motion/reprojection_problem.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/rigid_motion.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// The disparity bias that the features of one pair show.
struct BiasMeasurement {
  double bias_px = 0.0;    ///< relative to the camera that was passed
  double noise_px2 = 0.0;  ///< variance by the noise of single features
  /// Variance by errors that neighboring features share, if these are as large as the noise.
  double shared_px2 = 0.0;
  /// Estimated variance of the shared errors, divided by that of the noise. Its expectation is
  /// right, but a single value may be negative.
  double shared_ratio2 = 0.0;
  double smooth_px2 = 0.0;  ///< variance by errors that are smooth over the image
  Vector6d motion_by_bias = Vector6d::Zero();  ///< translation, then rotation
};

/// Measures the disparity bias of single pairs: with biased disparities, no motion explains both
/// near and far points. The bias is one more unknown of Eq. 25, estimated together with the motion.
///
/// Neighboring features share errors: of lenses and rectification, of matching at edges. In the
/// model, all features in a cell of the image have a common disparity error. Its variance is
/// estimated by the method of moments (DerSimonian and Laird 1986) from the amount by which the
/// cells disagree about the bias beyond their noise.
///
/// What lenses leave is smooth over the image. Near points are at its bottom and sides, so that
/// part of such errors passes for a bias. The largest one, parabolaOverRows(), is estimated
/// together with the bias. Those by the columns add to the uncertainty.
class BiasMeter {
 public:
  /// Starts at the given motion, with depths as triangulated for `camera`. None if the features do
  /// not determine a bias, as at standstill.
  std::optional<BiasMeasurement> measure(const StereoCamera& camera,
                                         const Correspondences& features,
                                         const Eigen::Isometry3d& T_keyframe_cur);

 private:
  static constexpr int kColumns = 6;
  static constexpr int kRows = 3;
  static constexpr int kCells = kColumns * kRows;
  using PerCell = Eigen::Matrix<double, kCells, 1>;

  /// The unknowns but those of the cells: rotation, translation and the parabola.
  static constexpr int kCommon = 7;
  static constexpr int kParabola = 6;
  using Common = Eigen::Matrix<double, kCommon, 1>;
  using CommonByCell = Eigen::Matrix<double, kCommon, kCells>;

  /// The normal equations of the common unknowns and of one disparity error per cell.
  struct Equations {
    Eigen::Matrix<double, kCommon, kCommon> common =
        Eigen::Matrix<double, kCommon, kCommon>::Zero();
    CommonByCell common_by_cell = CommonByCell::Zero();
    PerCell cells = PerCell::Zero();
    Common common_residual = Common::Zero();
    PerCell cell_residual = PerCell::Zero();
  };

  /// The same equations without the common unknowns: information * errors = weighted.
  struct Cells {
    Eigen::Matrix<double, kCells, kCells> information;
    PerCell weighted;
    PerCell of_bias;  ///< information times an error of all cells alike
    double bias_information;
    double bias_px;
    Common common_by_bias;
    Common common_step;
  };

  void change(const Common& common, double bias_px);
  WeightedVariance linearize();
  Equations sumEquations() const;
  static Cells eliminateCommon(const Equations& equations);
  static double effectOfSmoothErrors(const Cells& cells);
  std::optional<BiasMeasurement> describe();

  // The current step of one measurement, reused.
  double parabola_px_ = 0.0;
  StereoCamera camera_;
  Correspondences features_;
  Eigen::Isometry3d T_keyframe_cur_ = Eigen::Isometry3d::Identity();
  Fit fit_;
  FeatureSet all_;
  ReprojectionProblem<6> problem_;
};

}  // namespace rotrocc
