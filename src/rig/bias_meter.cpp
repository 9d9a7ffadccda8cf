#include "rig/bias_meter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/image_grid.h"

namespace rotrocc {
namespace {

/// Number of parameters of motion and bias.
constexpr int kParameters = 7;

/// With fewer features, the bias can hardly be distinguished from the motion.
constexpr std::size_t kLeastFeatures = 30;

/// Iterations end after a step below kSettled_px, because one more is added to the result. Without
/// parallax the bias is undetermined and steps would be arbitrarily long.
constexpr int kMostSteps = 15;
constexpr double kSettled_px = 0.05;
constexpr double kLongestStep_px = 1.0;

/// Standard deviation from which on a measurement says nothing: a drive has 0.02 to 0.6 px, a robot
/// at rest 8 px and more.
constexpr double kMostSigma_px = 5.0;

}  // namespace

bool BiasMeter::measure(const StereoCamera& camera,
                        const Correspondences& features,
                        const FeatureSet& set,
                        const Eigen::Isometry3d& T_keyframe_cur,
                        BiasMeasurement& measurement) {
  camera_ = camera;
  T_keyframe_cur_ = T_keyframe_cur;
  features_.clear();
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (set[i] != 0) features_.push_back(features[i]);
  }
  for (int step = 0; step < kMostSteps && features_.size() >= kLeastFeatures; ++step) {
    const Sums sums = collect(Curvature::kConvex);
    const Cells cells = eliminateMotion(sums);
    const double variance_px2 = sums.variance.value(kParameters) / cells.bias_information;
    if (!(variance_px2 < kMostSigma_px * kMostSigma_px)) return false;
    if (!std::isfinite(cells.bias_px)) return false;
    const double change_px = std::clamp(cells.bias_px, -kLongestStep_px, kLongestStep_px);
    const Vector6d moved = cells.motion_step + cells.motion_by_bias * change_px;
    T_keyframe_cur_.linear() = expRotation(moved.head<3>()) * T_keyframe_cur_.linear();
    T_keyframe_cur_.translation() += moved.tail<3>();
    camera_.cx_right += change_px;
    triangulate(camera_, features_);
    if (std::abs(change_px) < kSettled_px) break;
  }
  if (features_.size() < kLeastFeatures) return false;
  measurement.bias_px = camera_.cx_right - camera.cx_right;
  const Sums sums = collect(Curvature::kExpected);
  return describe(sums, eliminateMotion(sums), measurement);
}

/// Linearises the residuals at the current step.
BiasMeter::Sums BiasMeter::collect(Curvature curvature) {
  fitAt({camera_, features_, noise_ratio_}, T_keyframe_cur_, fit_);
  all_.assign(features_.size(), 1);
  problem_.assign(camera_, fit_, all_);
  problem_.weigh(problem_.start(), robust_factor_);
  Sums sums;
  problem_.visitResiduals(problem_.start(), [&](const ReprojectionProblem<6>::Residual& residual) {
    sums.squared_weights += residual.weight * residual.weight;
    sums.variance.add(residual.weight, residual.residual_px.squaredNorm());
  });
  sumEquations(sums);
  if (curvature == Curvature::kConvex) return sums;
  Sums expected = sums;
  problem_.squareWeights();
  sumEquations(expected);
  expected.motion_residual = sums.motion_residual;
  expected.cell_residual = sums.cell_residual;
  return expected;
}

/// Adds up the equations with the present weights. A bias changes disparities as an error of theirs
/// does, up to the sign.
void BiasMeter::sumEquations(Sums& sums) const {
  const ImageGrid grid(camera_, kColumns, kRows);
  sums.motion_by_cell.setZero();
  sums.cells.setZero();
  sums.cell_residual.setZero();
  const auto normal =
      problem_.sumTerms(problem_.start(), [&](const ReprojectionProblem<6>::ByDisparity& feature) {
        const auto cell = static_cast<Eigen::Index>(grid.cell(features_[feature.feature].cur_px));
        sums.motion_by_cell.col(cell) -= feature.product.head<6>();
        sums.cells[cell] += feature.information;
        sums.cell_residual[cell] -= feature.product[6];
      });
  sums.motion = normal.topLeftCorner<6, 6>();
  sums.motion_residual = normal.topRightCorner<6, 1>();
}

BiasMeter::Cells BiasMeter::eliminateMotion(const Sums& sums) {
  const Eigen::LDLT<Matrix6d> solver(sums.motion);
  const Eigen::Matrix<double, 6, kCells> of_cells = solver.solve(sums.motion_by_cell);
  const Vector6d of_residual = solver.solve(sums.motion_residual);
  Cells cells;
  cells.information = -sums.motion_by_cell.transpose() * of_cells;
  cells.information.diagonal() += sums.cells;
  cells.weighted = sums.motion_by_cell.transpose() * of_residual - sums.cell_residual;
  cells.of_bias = cells.information.rowwise().sum();
  cells.bias_information = cells.of_bias.sum();
  cells.bias_px = cells.weighted.sum() / cells.bias_information;
  cells.motion_by_bias = -of_cells.rowwise().sum();
  cells.motion_step = -of_residual;
  return cells;
}

/// With information A, a = A 1 and I = 1^T a, the cells disagree by A M e = (A - a a^T / I) e. The
/// expectation of the squared disagreement is the trace of M A for the noise, and that of its
/// square for shared errors.
bool BiasMeter::describe(const Sums& sums, const Cells& cells, BiasMeasurement& measurement) {
  const double variance_px2 = sums.variance.value(kParameters);
  const double information = cells.bias_information;
  if (!(variance_px2 > 0.0) || !(information > 0.0)) return false;
  const Eigen::Matrix<double, kCells, kCells> within =
      cells.information - cells.of_bias * cells.of_bias.transpose() / information;
  const PerCell disagreement = cells.weighted - cells.of_bias * cells.bias_px;
  const double excess_px2 =
      (disagreement.squaredNorm() - variance_px2 * within.trace()) / within.squaredNorm();
  // Mean square of the flow that one pixel of disparity causes.
  const double slope2 = sums.cells.sum() / sums.squared_weights;
  measurement.bias_px += cells.bias_px;
  measurement.noise_px2 = variance_px2 / information;
  measurement.shared_px2 =
      variance_px2 / slope2 * cells.of_bias.squaredNorm() / (information * information);
  measurement.shared_ratio2 = excess_px2 * slope2 / variance_px2;
  measurement.motion_by_bias << cells.motion_by_bias.tail<3>(), cells.motion_by_bias.head<3>();
  return std::isfinite(measurement.bias_px) && std::isfinite(measurement.noise_px2) &&
         std::isfinite(measurement.shared_px2) && std::isfinite(measurement.shared_ratio2) &&
         measurement.motion_by_bias.allFinite();
}

}  // namespace rotrocc
