#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "check/rig_causes.h"
#include "check/windows.h"
#include "common/image_grid.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {

/// Standard deviations of the values before anything is measured: those of a bad calibration. They
/// decide only what the images do not.
constexpr RigCauses kPriorSigmas = {
    0.02, 0.02, 0.02, 0.03, 10.0, 0.1, 0.03, 10.0, 0.02, 0.1, 100.0, 100.0};

using CauseVector = Eigen::Matrix<double, kRigCauses, 1>;

/// Sum of w [J r]^T [J r] over residuals r with the derivatives J by the values, up to the sign.
using Normal = Eigen::Matrix<double, kRigCauses + 1, kRigCauses + 1>;

/// [-de/dvalues, e] of the motion error e that fits the flows of a pair best.
using MotionError = Eigen::Matrix<double, 6, kRigCauses + 1>;

/// The least squares of a rig: rows, and flows with the error of each pair's motion eliminated,
/// with robust weights, by Gauss and Newton.
class RigProblem {
 public:
  RigProblem(const StereoCamera& camera,
             const std::vector<PairSamples>& pairs,
             const Windows& windows);

  /// Solves for the values that are not left out.
  void solve();

  /// Of values, at the solution: the largest ones of independent errors, of the scatter without
  /// each window of time, and without each part of the image, which has errors that the causes do
  /// not describe.
  RigCauses sigmas() const;

  /// The values of some causes by each window alone, at the other values; of infinite deviation if
  /// it does not show them.
  std::vector<std::vector<Estimate>> courses(const std::vector<RigCause>& causes,
                                             const Windows& windows) const;

  /// See RigModel: of rows and flows. Values that are zero in `corrected` are not corrected.
  std::pair<Estimate, Estimate> gains(const RigCauses& corrected) const;

  /// See RigModel.
  RigCauses causesOf(const RigCauses& some_values) const;

  void leaveOut(std::size_t cause);
  bool isLeftOut(std::size_t cause) const { return is_left_out_[cause]; }

  RigCauses values = {};
  std::array<bool, kRigCauses> is_of_turn = {};  ///< kOffset and kBias that a turn makes alone

 private:
  /// Parts of the image, columns and rows, each of which is left out once.
  static constexpr int kRegionColumns = 4;
  static constexpr int kRegionRows = 2;
  static constexpr std::size_t kRegions = kRegionColumns * kRegionRows;

  /// Derivatives of a flow by the error of the motion and by the values, and what is left of it;
  /// along and across the change of the flow by the disparity, over their noise.
  using FlowResidual = Eigen::Matrix<double, 2, 6 + kRigCauses + 1>;
  using Jacobian = Eigen::Matrix<double, 2, kRigCauses>;

  void linearize();
  FlowResidual residualOf(const PairSamples& pair,
                          const RigSample& sample,
                          double displaced_px,
                          const Eigen::Matrix<double, 1, kRigCauses>& by_values) const;
  void addFlows(std::size_t pair,
                const std::vector<std::pair<FlowResidual, std::size_t>>& residuals);
  Normal prior() const;
  Normal total() const;
  Normal totalWithout(std::size_t window) const;
  Normal restricted(Normal normal) const;
  CauseVector changeBy(const Normal& normal) const;

  const StereoCamera& camera_;
  const std::vector<PairSamples>& pairs_;
  ImageGrid regions_grid_;
  std::array<bool, kRigCauses> is_left_out_ = {};  // these are zero
  std::vector<std::size_t> window_of_;             // of a pair
  std::vector<MotionError> motion_errors_;         // of each pair
  RigCauses linearized_at_ = {};                   // values of motion_errors_
  std::vector<Normal> rows_, flows_;               // for each window
  std::array<Normal, kRegions> without_;           // each part of the image: flows, minus its rows
  double row_noise_px_ = 1.0;
  double flow_noise_ = 1.0;  // over that of the odometry
};

}  // namespace rotrocc
