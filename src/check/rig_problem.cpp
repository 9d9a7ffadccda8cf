#include "check/rig_problem.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "common/median.h"

namespace rotrocc {
namespace {

constexpr double kDifference = 1e-3;  // of derivatives, over kPriorSigmas

constexpr double kLeastNoise_px = 0.02;

/// Residuals of more standard deviations count less: windows at edges, and wrong matches.
constexpr double kRobust = 1.5;

constexpr auto kCauses = static_cast<int>(kRigCauses);

double cauchyWeight(double sigmas) {
  return 1.0 / (1.0 + std::pow(sigmas / kRobust, 2));
}

Normal sumOf(const std::vector<Normal>& parts) {
  return std::accumulate(parts.begin(), parts.end(), Normal(Normal::Zero()));
}

/// How much less a sum of squares is after a change of the values.
double gainBy(const CauseVector& change, const Normal& sum) {
  return 2.0 * change.dot(sum.topRightCorner<kCauses, 1>()) -
         change.dot(sum.topLeftCorner<kCauses, kCauses>() * change);
}

/// What the error of a motion leaves of a flow.
Eigen::Vector2d leftOf(const Eigen::Matrix<double, 2, 6 + kCauses + 1>& flow,
                       const MotionError& error) {
  return flow.rightCols<1>() - flow.leftCols<6>() * error.rightCols<1>();
}

/// Sums over the flows of a pair, which share the error of its motion: of J^T J, and their number.
struct FlowSums {
  using Matrix = Eigen::Matrix<double, 6 + kCauses + 1, 6 + kCauses + 1>;
  Matrix matrix = Matrix::Zero();
  int count = 0;

  /// Without the error of the motion, which is found. False if too few determine it.
  bool eliminate(MotionError& error, Normal& eliminated) const {
    constexpr int kLeast = 12;  // of twice as many residuals, a fourth for the motion
    if (count < kLeast) return false;
    const Eigen::Matrix<double, 6, kCauses + 1> mixed = matrix.topRightCorner<6, kCauses + 1>();
    const MotionError solved = matrix.topLeftCorner<6, 6>().ldlt().solve(mixed);
    if (!solved.allFinite()) return false;
    error = solved;
    eliminated = matrix.bottomRightCorner<kCauses + 1, kCauses + 1>() - mixed.transpose() * solved;
    return true;
  }
};

}  // namespace

RigProblem::RigProblem(const StereoCamera& camera,
                       const std::vector<PairSamples>& pairs,
                       const Windows& windows)
    : camera_(camera),
      pairs_(pairs),
      regions_grid_(camera.width, camera.height, kRegionColumns, kRegionRows),
      motion_errors_(pairs.size(), MotionError::Zero()),
      rows_(windows.count()),
      flows_(windows.count()) {
  for (const PairSamples& pair : pairs) window_of_.push_back(windows.of(pair.time_s));
}

void RigProblem::solve() {
  constexpr int kLeastSteps = 2, kMostSteps = 20;  // the first one does not know the noise
  constexpr double kLeastGain = 0.01;              // a tenth of a standard deviation
  linearize();
  double gain = INFINITY;
  for (int i = 0; i < kMostSteps && (i < kLeastSteps || gain > kLeastGain); ++i) {
    const Normal sum = total();
    const CauseVector change = changeBy(sum);
    gain = gainBy(change, sum);
    CauseVector::Map(values.data()) += change;
    linearize();
  }
}

RigCauses RigProblem::sigmas() const {
  Eigen::MatrixXd windows(kCauses, rows_.size()), regions(kCauses, kRegions);
  for (std::size_t w = 0; w < rows_.size(); ++w) {
    windows.col(Eigen::Index(w)) = changeBy(totalWithout(w));
  }
  const Normal of_rows = prior() + sumOf(rows_);
  for (std::size_t r = 0; r < kRegions; ++r) {
    regions.col(Eigen::Index(r)) = changeBy(of_rows + without_[r]);
  }
  // What matching leaves is alike in a part of the image, so that independent errors are more.
  constexpr double kMatching_px = 0.01;
  constexpr double kParts = 80.0;
  double count = 0.0;
  for (const PairSamples& pair : pairs_) count += static_cast<double>(pair.samples.size());
  const double factor = 1.0 + count / kParts * std::pow(kMatching_px / row_noise_px_, 2);
  const Eigen::MatrixXd independent =
      factor * restricted(total()).topLeftCorner<kCauses, kCauses>().inverse();
  RigCauses sigmas;
  CauseVector::Map(sigmas.data()) = independent.diagonal()
                                        .cwiseSqrt()
                                        .cwiseMax(jackknifeSigmas(windows))
                                        .cwiseMax(jackknifeSigmas(regions));
  return sigmas;
}

std::vector<std::vector<Estimate>> RigProblem::courses(const std::vector<RigCause>& causes,
                                                       const Windows& windows) const {
  constexpr double kKnown = 0.1;  // of the prior
  std::vector<std::vector<PairSamples>> parts(windows.count());
  for (const PairSamples& pair : pairs_) {
    const std::size_t w = windows.of(pair.time_s);
    parts[w].push_back(pair);
    parts[w].back().time_s = static_cast<double>(parts[w].size() - 1);
  }
  std::vector<std::vector<Estimate>> courses(causes.size());
  for (const std::vector<PairSamples>& part : parts) {
    RigProblem alone(camera_, part, Windows(double(part.size()), part.size(), 5));
    alone.values = values;
    alone.is_of_turn = is_of_turn;
    alone.is_left_out_.fill(true);
    for (const RigCause cause : causes) alone.is_left_out_[cause] = false;
    alone.solve();
    const RigCauses sigmas = alone.sigmas();
    for (std::size_t k = 0; k < causes.size(); ++k) {
      const double sigma = sigmas[causes[k]];  // of one pair, there is no scatter
      const bool is_known = part.size() > 1 && sigma < kKnown * kPriorSigmas[causes[k]];
      courses[k].push_back({alone.values[causes[k]], is_known ? sigma : INFINITY});
    }
  }
  return courses;
}

std::pair<Estimate, Estimate> RigProblem::gains(const RigCauses& corrected) const {
  const CauseVector now = CauseVector::Map(values.data());
  std::vector<double> rows, flows;
  for (std::size_t w = 0; w < rows_.size(); ++w) {
    CauseVector by_others = now + changeBy(totalWithout(w));
    for (std::size_t k = 0; k < kRigCauses; ++k) {
      if (corrected[k] == 0.0) by_others[Eigen::Index(k)] = 0.0;
    }
    rows.push_back(gainBy(by_others - now, rows_[w]) - gainBy(-now, rows_[w]));
    flows.push_back(gainBy(by_others - now, flows_[w]) - gainBy(-now, flows_[w]));
  }
  const auto count = static_cast<double>(rows.size());
  return {meanOf(rows) * count, meanOf(flows) * count};
}

RigCauses RigProblem::causesOf(const RigCauses& some_values) const {
  RigCauses causes = some_values;
  if (!is_of_turn[kOffset]) causes[kOffset] -= camera_.fy * some_values[kPitch];
  if (!is_of_turn[kBias]) causes[kBias] += camera_.fx * some_values[kYaw];
  return causes;
}

void RigProblem::leaveOut(std::size_t cause) {
  is_left_out_[cause] = true;
  values[cause] = linearized_at_[cause] = 0.0;  // no motion follows: it is noise, or now a turn
}

/// Sums of squares at the values, and the noise of what is left there, for the next time.
void RigProblem::linearize() {
  const CauseVector change =
      CauseVector::Map(values.data()) - CauseVector::Map(linearized_at_.data());
  for (MotionError& error : motion_errors_) {
    error.rightCols<1>() -= error.leftCols<kCauses>() * change;
  }
  linearized_at_ = values;
  const RigDisplacement displacement(camera_, causesOf(values));
  std::vector<std::pair<Eigen::Index, RigDisplacement>> steps;
  for (std::size_t k = 0; k < kRigCauses; ++k) {
    if (is_left_out_[k]) continue;
    RigCauses changed = values;
    changed[k] += kDifference * kPriorSigmas[k];
    steps.emplace_back(Eigen::Index(k), RigDisplacement(camera_, causesOf(changed)));
  }
  for (std::vector<Normal>* windows : {&rows_, &flows_}) {
    std::fill(windows->begin(), windows->end(), Normal::Zero());
  }
  without_.fill(Normal::Zero());
  std::vector<double> row_errors_px, flow_errors;
  std::vector<std::pair<FlowResidual, std::size_t>> residuals;
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    residuals.clear();
    for (const RigSample& sample : pairs_[p].samples) {
      const std::size_t region = regions_grid_.cell(sample.left_px.x, sample.left_px.y);
      const Eigen::Vector2d at = displacement.of(sample);
      Jacobian jacobian = Jacobian::Zero();
      for (const auto& [k, step] : steps) {
        jacobian.col(k) =
            (step.of(sample) - at) / (kDifference * kPriorSigmas[static_cast<std::size_t>(k)]);
      }
      if (std::isfinite(sample.row_px)) {
        const double error_px = sample.row_px - at.y();
        row_errors_px.push_back(std::abs(error_px));
        Eigen::Matrix<double, 1, kCauses + 1> row;
        row << jacobian.row(1), error_px;
        row *= std::sqrt(cauchyWeight(error_px / row_noise_px_)) / row_noise_px_;
        rows_[window_of_[p]] += row.transpose() * row;
        without_[region] -= row.transpose() * row;
      }
      if (sample.flow_by_disparity.isZero()) continue;
      residuals.emplace_back(residualOf(pairs_[p], sample, at.x(), jacobian.row(0)), region);
    }
    addFlows(p, residuals);
    for (const auto& [residual, region] : residuals) {
      flow_errors.push_back(flow_noise_ * std::abs(leftOf(residual, motion_errors_[p])[0]));
    }
  }
  for (const auto& [errors, noise] :
       {std::pair(&row_errors_px, &row_noise_px_), {&flow_errors, &flow_noise_}}) {
    if (!errors->empty()) *noise = std::max(kDeviationOverMedian * median(*errors), kLeastNoise_px);
  }
}

/// Disparities have the noise of a match, as flows have.
RigProblem::FlowResidual RigProblem::residualOf(
    const PairSamples& pair,
    const RigSample& sample,
    double displaced_px,
    const Eigen::Matrix<double, 1, kRigCauses>& by_values) const {
  const double length = sample.flow_by_disparity.norm();
  const double noise_px = flow_noise_ * pair.flow_noise_px;
  Eigen::Matrix2d axes;
  axes.row(0) = sample.flow_by_disparity.transpose() / length;
  axes.row(1) << -axes(0, 1), axes(0, 0);
  axes.row(0) /= noise_px * std::sqrt(1.0 + length * length);
  axes.row(1) /= noise_px;
  const double error_px = displaced_px - pair.applied_px - pair.late_s * sample.velocity_pxps.x();
  const double damped = 1.0 / std::max(1.0 + sample.damping_ppx * error_px, 0.2);  // wrong matches
  Jacobian jacobian = damped * damped * sample.flow_by_disparity * by_values;
  for (int k = kBothLenses; k < kCauses; ++k) {
    if (!isLeftOut(k)) jacobian.col(k) = sample.flow_by_both.col(k - kBothLenses);
  }
  FlowResidual residual;
  residual << axes * sample.flow_by_motion, axes * jacobian,
      axes * (sample.flow_px - damped * error_px * sample.flow_by_disparity -
              sample.flow_by_both * Eigen::Map<const Eigen::Vector3d>(&values[kBothLenses]));
  return residual;
}

/// Adds the flows of a pair, also without each part of the image.
void RigProblem::addFlows(std::size_t pair,
                          const std::vector<std::pair<FlowResidual, std::size_t>>& residuals) {
  std::array<FlowSums, kRegions> parts;
  for (const auto& [residual, region] : residuals) {
    const double sigmas = leftOf(residual, motion_errors_[pair]).norm() / std::sqrt(2.0);
    // Of Geman and McClure (1987): with Cauchy's, wrong matches of a busy street move the bias.
    const double weight = std::pow(cauchyWeight(sigmas), 2);
    parts[region].matrix += (weight * residual.transpose()).lazyProduct(residual);
    ++parts[region].count;
  }
  FlowSums all;
  for (const FlowSums& part : parts) all = {all.matrix + part.matrix, all.count + part.count};
  Normal eliminated;
  if (!all.eliminate(motion_errors_[pair], eliminated)) return;
  flows_[window_of_[pair]] += eliminated;
  for (std::size_t r = 0; r < kRegions; ++r) {
    const FlowSums rest = {all.matrix - parts[r].matrix, all.count - parts[r].count};
    MotionError error;
    if (rest.eliminate(error, eliminated)) without_[r] += eliminated;
  }
}

Normal RigProblem::prior() const {
  Normal normal = Normal::Zero();
  for (std::size_t k = 0; k < kRigCauses; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    normal(i, i) = 1.0 / std::pow(kPriorSigmas[k], 2);
    normal(i, kCauses) = normal(kCauses, i) = -values[k] / std::pow(kPriorSigmas[k], 2);
  }
  return normal;
}

Normal RigProblem::total() const {
  return prior() + sumOf(rows_) + sumOf(flows_);
}

Normal RigProblem::totalWithout(std::size_t window) const {
  return total() - rows_[window] - flows_[window];
}

/// With ones for what is left out.
Normal RigProblem::restricted(Normal normal) const {
  for (std::size_t k = 0; k < kRigCauses; ++k) {
    if (!is_left_out_[k]) continue;
    const auto i = static_cast<Eigen::Index>(k);
    normal.row(i).setZero();
    normal.col(i).setZero();
    normal(i, i) = 1.0;
  }
  return normal;
}

/// Of the values, to the least sum of squares.
CauseVector RigProblem::changeBy(const Normal& normal) const {
  const Normal free = restricted(normal);
  return free.topLeftCorner<kCauses, kCauses>().ldlt().solve(free.topRightCorner<kCauses, 1>());
}

}  // namespace rotrocc
