#include "rig/bias_meter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "motion/feature_errors.h"
#include "motion/reprojection_problem.h"

namespace rotrocc {
namespace {

/// Number of parameters of motion, parabola and bias.
constexpr int kParameters = 8;

/// With fewer features, the bias can hardly be distinguished from the motion.
constexpr std::size_t kLeastFeatures = 30;

/// Ratio of disparity noise to flow noise, see fitted_feature.h: that of single matches. With a
/// larger one, the fitted disparities would also absorb errors that neighbors share, and with them
/// a part of the bias.
constexpr double kNoiseRatio = 1.0;

/// Iterations end after a step below kSettled_px, because one more is added to the result. Without
/// parallax the bias is undetermined and steps would be arbitrarily long.
constexpr int kMostSteps = 15;
constexpr double kSettled_px = 0.05;
constexpr double kLongestStep_px = 1.0;

/// Standard deviation from which on a measurement says nothing: a drive has 0.02 to 0.6 px, a robot
/// at rest 8 px and more.
constexpr double kMostSigma_px = 5.0;

}  // namespace

std::optional<BiasMeasurement> BiasMeter::measure(const StereoCamera& camera,
                                                  const Correspondences& features,
                                                  const Eigen::Isometry3d& T_keyframe_cur) {
  camera_ = camera;
  T_keyframe_cur_ = T_keyframe_cur;
  parabola_px_ = 0.0;
  features_ = features;
  for (int step = 0; step < kMostSteps && features_.size() >= kLeastFeatures; ++step) {
    const WeightedVariance variance = linearize();
    const Cells cells = eliminateCommon(sumEquations());
    const double variance_px2 = variance.value(kParameters) / cells.bias_information;
    if (!(variance_px2 < kMostSigma_px * kMostSigma_px)) return std::nullopt;
    if (!std::isfinite(cells.bias_px)) return std::nullopt;
    const double change_px = std::clamp(cells.bias_px, -kLongestStep_px, kLongestStep_px);
    change(cells.common_step + cells.common_by_bias * change_px, change_px);
    if (std::abs(change_px) < kSettled_px) break;
  }
  if (features_.size() < kLeastFeatures) return std::nullopt;
  auto measurement = describe();
  if (measurement) measurement->bias_px += camera_.cx_right - camera.cx_right;
  return measurement;
}

void BiasMeter::change(const Common& common, double bias_px) {
  T_keyframe_cur_.linear() = expRotation(common.head<3>()) * T_keyframe_cur_.linear();
  T_keyframe_cur_.translation() += common.segment<3>(3);
  parabola_px_ += common[kParabola];
  for (Correspondence& feature : features_) {
    feature.disparity_px += common[kParabola] * parabolaOverRows(camera_, feature.cur_px);
  }
  camera_.cx_right += bias_px;
  triangulate(camera_, features_);
}

/// Sets the problem of the current step.
WeightedVariance BiasMeter::linearize() {
  fitAt({camera_, features_, kNoiseRatio}, T_keyframe_cur_, fit_);
  all_.assign(features_.size(), 1);
  problem_.assign(camera_, fit_, all_);
  problem_.weigh(problem_.start(), kCauchyFactor);
  WeightedVariance variance;
  problem_.visitResiduals(problem_.start(), [&](const ReprojectionProblem<6>::Residual& residual) {
    variance.add(residual.weight, residual.residual_px.squaredNorm());
  });
  return variance;
}

/// Adds up the equations with the present weights. A bias changes disparities as an error of theirs
/// does, up to the sign.
BiasMeter::Equations BiasMeter::sumEquations() const {
  const ImageGrid grid(camera_, kColumns, kRows);
  Equations sums;
  const auto normal =
      problem_.sumTerms(problem_.start(), [&](const ReprojectionProblem<6>::ByDisparity& feature) {
        const Eigen::Vector2d& pixel = features_[feature.feature].cur_px;
        const auto cell = static_cast<Eigen::Index>(grid.cell(pixel));
        sums.common_by_cell.col(cell).head<6>() -= feature.product.head<6>();
        sums.cells[cell] += feature.information;
        sums.cell_residual[cell] -= feature.product[6];
        const double height = parabolaOverRows(camera_, pixel);
        sums.common.row(kParabola).head<6>() -= height * feature.product.head<6>();
        sums.common.col(kParabola).head<6>() -= height * feature.product.head<6>();
        sums.common(kParabola, kParabola) += height * height * feature.information;
        sums.common_by_cell(kParabola, cell) += height * feature.information;
        sums.common_residual[kParabola] -= height * feature.product[6];
      });
  sums.common.topLeftCorner<6, 6>() = normal.topLeftCorner<6, 6>();
  sums.common_residual.head<6>() = normal.topRightCorner<6, 1>();
  constexpr double kKnown = 1.0 / (kSmoothRatio * kSmoothRatio);
  sums.common(kParabola, kParabola) += kKnown;
  sums.common_residual[kParabola] += kKnown * parabola_px_;
  return sums;
}

BiasMeter::Cells BiasMeter::eliminateCommon(const Equations& sums) {
  const Eigen::LDLT<Eigen::Matrix<double, kCommon, kCommon>> solver(sums.common);
  const CommonByCell of_cells = solver.solve(sums.common_by_cell);
  const Common of_residual = solver.solve(sums.common_residual);
  Cells cells;
  cells.information = -sums.common_by_cell.transpose() * of_cells;
  cells.information.diagonal() += sums.cells;
  cells.weighted = sums.common_by_cell.transpose() * of_residual - sums.cell_residual;
  cells.of_bias = cells.information.rowwise().sum();
  cells.bias_information = cells.of_bias.sum();
  cells.bias_px = cells.weighted.sum() / cells.bias_information;
  cells.common_by_bias = -of_cells.rowwise().sum();
  cells.common_step = -of_residual;
  return cells;
}

/// Sum of the squared changes of the bias by errors that are not estimated: x^2 and x y, where x
/// and y are -1 and 1 at the borders of the image.
double BiasMeter::effectOfSmoothErrors(const Cells& cells) {
  Eigen::Vector2d changes = Eigen::Vector2d::Zero();
  for (int cell = 0; cell < kCells; ++cell) {
    const double x = (2.0 * (cell % kColumns) + 1.0) / kColumns - 1.0;
    const double y = (2.0 * (cell / kColumns) + 1.0) / kRows - 1.0;
    changes += cells.of_bias[cell] / cells.bias_information * Eigen::Vector2d(x * x, x * y);
  }
  return changes.squaredNorm();
}

/// With information A, a = A 1 and I = 1^T a, the cells disagree by A M e = (A - a a^T / I) e. The
/// expectation of the squared disagreement is the trace of M A for the noise, and that of its
/// square for shared errors.
std::optional<BiasMeasurement> BiasMeter::describe() {
  const WeightedVariance variance = linearize();
  const Equations reweighted = sumEquations();
  // The curvature of reweighted least squares never overshoots. That which the robust cost has on
  // average, from the squared weights (see motion_estimator.cpp), gives the uncertainty.
  problem_.squareWeights();
  Equations expected = sumEquations();
  expected.common_residual = reweighted.common_residual;
  expected.cell_residual = reweighted.cell_residual;
  const Cells cells = eliminateCommon(expected);
  const double variance_px2 = variance.value(kParameters);
  const double information = cells.bias_information;
  if (!(variance_px2 > 0.0) || !(information > 0.0)) return std::nullopt;
  const Eigen::Matrix<double, kCells, kCells> within =
      cells.information - cells.of_bias * cells.of_bias.transpose() / information;
  const PerCell disagreement = cells.weighted - cells.of_bias * cells.bias_px;
  const double excess_px2 =
      (disagreement.squaredNorm() - variance_px2 * within.trace()) / within.squaredNorm();
  // Mean square of the flow that one pixel of disparity causes.
  const double slope2 = expected.cells.sum() / variance.squaredWeights();
  BiasMeasurement measurement;
  measurement.bias_px = cells.bias_px;
  measurement.noise_px2 = variance_px2 / information;
  measurement.shared_px2 =
      variance_px2 / slope2 * cells.of_bias.squaredNorm() / (information * information);
  measurement.shared_ratio2 = excess_px2 * slope2 / variance_px2;
  measurement.smooth_px2 = variance_px2 * kSmoothRatio * kSmoothRatio * effectOfSmoothErrors(cells);
  const Common& by_bias = cells.common_by_bias;
  measurement.motion_by_bias << by_bias.segment<3>(3), by_bias.head<3>();
  const bool is_finite =
      std::isfinite(measurement.bias_px) && std::isfinite(measurement.noise_px2) &&
      std::isfinite(measurement.shared_px2) && std::isfinite(measurement.shared_ratio2) &&
      std::isfinite(measurement.smooth_px2) && measurement.motion_by_bias.allFinite();
  return is_finite ? std::optional(measurement) : std::nullopt;
}

}  // namespace rotrocc
