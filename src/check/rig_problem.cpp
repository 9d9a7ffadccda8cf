#include "check/rig_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "common/median.h"

namespace rotrocc {
namespace {

constexpr double kStep = 1e-3;  // of derivatives, over kPriorSigmas

constexpr double kLeastNoise_px = 0.02;

/// Residuals of more standard deviations count less: windows at edges, and wrong matches.
constexpr double kRobust = 1.5;

/// From a start of zero, errors of a bad calibration need two.
constexpr int kIterations = 4;

constexpr double kUnknown = std::numeric_limits<double>::infinity();

double square(double value) {
  return value * value;
}

double weightOf(double sigmas) {
  return 1.0 / (1.0 + square(sigmas / kRobust));
}

}  // namespace

Normal& Normal::operator+=(const Normal& other) {
  H += other.H;
  g += other.g;
  return *this;
}

Normal& Normal::operator-=(const Normal& other) {
  H -= other.H;
  g -= other.g;
  return *this;
}

double Normal::gainBy(const CauseVector& change) const {
  return 2.0 * g.dot(change) - change.dot(H * change);
}

/// Along and across the change of the flow by the disparity, over their noise.
struct RigProblem::FlowResidual {
  Eigen::Vector2d value;
  Eigen::Matrix<double, 2, 6> by_motion;
  Jacobian by_values;
  std::size_t region;
};

/// Sums over the flows of a pair, which share the error of its motion.
struct RigProblem::FlowSums {
  Matrix6d A = Matrix6d::Zero();
  Eigen::Matrix<double, 6, kRigCauses> B = Eigen::Matrix<double, 6, kRigCauses>::Zero();
  Vector6d a = Vector6d::Zero();
  Normal normal;
  int count = 0;

  void add(const FlowResidual& residual, double weight) {
    A += weight * residual.by_motion.transpose() * residual.by_motion;
    B += weight * residual.by_motion.transpose() * residual.by_values;
    a += weight * residual.by_motion.transpose() * residual.value;
    normal.H += weight * residual.by_values.transpose() * residual.by_values;
    normal.g += weight * residual.by_values.transpose() * residual.value;
    ++count;
  }

  FlowSums without(const FlowSums& part) const {
    FlowSums rest = *this;
    rest.A -= part.A;
    rest.B -= part.B;
    rest.a -= part.a;
    rest.normal -= part.normal;
    rest.count -= part.count;
    return rest;
  }

  /// Without the error of the motion, which is found. False if too few determine it.
  bool eliminate(Vector6d& motion, Normal& eliminated) const {
    constexpr int kLeast = 12;  // of twice as many residuals, a fourth for the motion
    if (count < kLeast) return false;
    const Eigen::LDLT<Matrix6d> inverse(A);
    const Vector6d solved = inverse.solve(a);
    if (!solved.allFinite()) return false;
    motion = solved;
    eliminated = normal;
    eliminated.H -= B.transpose() * inverse.solve(B);
    eliminated.g -= B.transpose() * motion;
    return true;
  }
};

RigProblem::RigProblem(const StereoCamera& camera,
                       const std::vector<PairSamples>& pairs,
                       const Windows& windows)
    : camera_(camera),
      pairs_(pairs),
      regions_grid_(camera.width, camera.height, kRegionColumns, kRegionRows),
      motions_(pairs.size(), Vector6d::Zero()),
      rows_(windows.count()),
      flows_(windows.count()) {
  for (const PairSamples& pair : pairs) window_of_.push_back(windows.of(pair.time_s));
}

void RigProblem::solve() {
  for (int i = 0; i < kIterations; ++i) {
    linearize();
    const CauseVector change = changeBy(total());
    for (std::size_t k = 0; k < kRigCauses; ++k) values[k] += change[Eigen::Index(k)];
  }
  linearize();
}

RigCauses RigProblem::sigmas() const {
  std::vector<std::vector<double>> windows, regions;
  const auto addTo = [](std::vector<std::vector<double>>& without, const CauseVector& change) {
    without.emplace_back(change.data(), change.data() + kRigCauses);
  };
  for (std::size_t w = 0; w < rows_.size(); ++w) addTo(windows, changeBy(totalWithout(w)));
  for (std::size_t r = 0; r < kRegions; ++r) {
    Normal sum = prior();
    for (const Normal& window : rows_) sum += window;
    sum -= rows_of_[r];
    sum += flows_without_[r];
    addTo(regions, changeBy(sum));
  }
  const std::vector<double> over_time = jackknifeSigmas(windows);
  const std::vector<double> over_image = jackknifeSigmas(regions);
  const CauseMatrix covariance =
      sharedFactor() * restricted(total().H).ldlt().solve(CauseMatrix::Identity());
  RigCauses sigmas;
  for (std::size_t k = 0; k < kRigCauses; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    sigmas[k] = std::max({std::sqrt(covariance(i, i)), over_time[k], over_image[k]});
  }
  return sigmas;
}

/// By which variances of independent errors increase, since what matching leaves is alike in a part
/// of the image.
double RigProblem::sharedFactor() const {
  constexpr double kMatching_px = 0.01;
  constexpr double kParts = 80.0;
  double count = 0.0;
  for (const PairSamples& pair : pairs_) count += static_cast<double>(pair.samples.size());
  return 1.0 + count / kParts * square(kMatching_px / row_noise_px_);
}

std::vector<Estimate> RigProblem::biases() {
  is_left_out_[kBias] = false;
  linearize();
  std::vector<Estimate> biases;
  for (const Normal& window : flows_) {
    const double information = window.H(kBias, kBias);
    // Less than a pixel is said by some motion of the features.
    const double sigma_px =
        information > 1.0 ? 1.0 / std::sqrt(information) : std::numeric_limits<double>::infinity();
    biases.push_back({values[kBias] + window.g[kBias] / information, sigma_px});
  }
  return biases;
}

std::vector<std::array<Estimate, 3>> RigProblem::planes(const Windows& windows) const {
  constexpr RigCause kPlane[] = {kOffset, kRoll, kFocal};
  constexpr double kKnown = 0.1;  // of the prior
  std::vector<std::vector<PairSamples>> parts(windows.count());
  for (const PairSamples& pair : pairs_) parts[windows.of(pair.time_s)].push_back(pair);
  std::vector<std::array<Estimate, 3>> planes;
  for (const std::vector<PairSamples>& part : parts) {
    RigProblem alone(camera_, part, windows);
    alone.values = values;
    alone.is_of_turn = is_of_turn;
    alone.is_left_out_.fill(true);
    for (const RigCause cause : kPlane) alone.is_left_out_[cause] = false;
    alone.solve();
    const CauseMatrix covariance = alone.restricted(alone.total().H).inverse();
    std::array<Estimate, 3>& plane = planes.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const RigCause cause = kPlane[k];
      const double sigma = std::sqrt(covariance(cause, cause));
      const bool is_known = sigma < kKnown * kPriorSigmas[cause];
      plane[k] = {alone.values[cause], is_known ? sigma : kUnknown};
    }
  }
  return planes;
}

std::pair<Estimate, Estimate> RigProblem::gains(const RigCauses& corrected) const {
  std::vector<double> rows, flows;
  const CauseVector now = Eigen::Map<const CauseVector>(values.data());
  for (std::size_t w = 0; w < rows_.size(); ++w) {
    CauseVector by_others = now + changeBy(totalWithout(w));
    for (std::size_t k = 0; k < kRigCauses; ++k) {
      if (corrected[k] == 0.0) by_others[Eigen::Index(k)] = 0.0;
    }
    rows.push_back(rows_[w].gainBy(by_others - now) - rows_[w].gainBy(-now));
    flows.push_back(flows_[w].gainBy(by_others - now) - flows_[w].gainBy(-now));
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
  values[cause] = 0.0;
}

/// Sums of squares at the values, and the noise of what is left there, for the next time.
void RigProblem::linearize() {
  const RigDisplacement displacement(camera_, causesOf(values));
  std::vector<std::pair<Eigen::Index, RigDisplacement>> steps;
  for (std::size_t k = 0; k < kRigCauses; ++k) {
    if (is_left_out_[k]) continue;
    RigCauses changed = values;
    changed[k] += kStep * kPriorSigmas[k];
    steps.emplace_back(Eigen::Index(k), RigDisplacement(camera_, causesOf(changed)));
  }
  std::fill(rows_.begin(), rows_.end(), Normal());
  std::fill(flows_.begin(), flows_.end(), Normal());
  rows_of_.fill({});
  flows_without_.fill({});
  std::vector<double> row_errors_px, flow_errors;
  std::vector<FlowResidual> residuals;
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    residuals.clear();
    for (const RigSample& sample : pairs_[p].samples) {
      const Eigen::Vector2d at = displacement.of(sample);
      Jacobian jacobian = Jacobian::Zero();
      for (const auto& [k, step] : steps) {
        jacobian.col(k) =
            (step.of(sample) - at) / (kStep * kPriorSigmas[static_cast<std::size_t>(k)]);
      }
      if (std::isfinite(sample.row_px)) {
        row_errors_px.push_back(std::abs(sample.row_px - at.y()));
        addRow(p, sample, sample.row_px - at.y(), jacobian.row(1).transpose());
      }
      if (sample.flow_by_disparity.isZero()) continue;
      residuals.push_back(residualOf(pairs_[p], sample, at.x(), jacobian.row(0)));
    }
    addFlows(p, residuals);
    for (const FlowResidual& residual : residuals) {
      flow_errors.push_back(std::abs(residual.value[0] - residual.by_motion.row(0) * motions_[p]));
    }
  }
  if (!row_errors_px.empty()) {
    row_noise_px_ = std::max(kDeviationOverMedian * median(row_errors_px), kLeastNoise_px);
  }
  if (!flow_errors.empty()) {
    flow_noise_ =
        std::max(flow_noise_ * kDeviationOverMedian * median(flow_errors), kLeastNoise_px);
  }
}

void RigProblem::addRow(std::size_t pair,
                        const RigSample& sample,
                        double error_px,
                        const CauseVector& by_values) {
  const double weight = weightOf(error_px / row_noise_px_) / square(row_noise_px_);
  const Normal normal = {weight * by_values * by_values.transpose(), weight * error_px * by_values};
  rows_[window_of_[pair]] += normal;
  rows_of_[regions_grid_.cell(sample.left_px.x, sample.left_px.y)] += normal;
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
  FlowResidual residual;
  residual.value =
      axes * (sample.flow_px - displaced_px * sample.flow_by_disparity -
              sample.flow_by_both * Eigen::Map<const Eigen::Vector3d>(&values[kBothLenses]));
  residual.by_motion = axes * sample.flow_by_motion;
  residual.by_values = axes * sample.flow_by_disparity * by_values;
  if (skew_is_of_rows) residual.by_values.col(kTimeSkew).setZero();
  for (std::size_t k = kBothLenses; k < kRigCauses; ++k) {
    if (is_left_out_[k]) continue;
    residual.by_values.col(Eigen::Index(k)) =
        axes * sample.flow_by_both.col(Eigen::Index(k - kBothLenses));
  }
  residual.region = regions_grid_.cell(sample.left_px.x, sample.left_px.y);
  return residual;
}

/// Adds those of a pair, also without each part of the image.
void RigProblem::addFlows(std::size_t pair, const std::vector<FlowResidual>& residuals) {
  FlowSums all;
  std::array<FlowSums, kRegions> parts;
  for (const FlowResidual& residual : residuals) {
    const Eigen::Vector2d left = residual.value - residual.by_motion * motions_[pair];
    const double weight = weightOf(left.norm() / std::sqrt(2.0));
    all.add(residual, weight);
    parts[residual.region].add(residual, weight);
  }
  Normal eliminated;
  if (!all.eliminate(motions_[pair], eliminated)) return;
  flows_[window_of_[pair]] += eliminated;
  for (std::size_t r = 0; r < kRegions; ++r) {
    Vector6d motion;
    if (all.without(parts[r]).eliminate(motion, eliminated)) flows_without_[r] += eliminated;
  }
}

Normal RigProblem::prior() const {
  Normal normal;
  for (std::size_t k = 0; k < kRigCauses; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    normal.H(i, i) = 1.0 / square(kPriorSigmas[k]);
    normal.g[i] = -values[k] / square(kPriorSigmas[k]);
  }
  return normal;
}

Normal RigProblem::total() const {
  Normal sum = prior();
  for (const Normal& window : rows_) sum += window;
  for (const Normal& window : flows_) sum += window;
  return sum;
}

Normal RigProblem::totalWithout(std::size_t window) const {
  Normal sum = total();
  sum -= rows_[window];
  sum -= flows_[window];
  return sum;
}

/// With ones for what is left out.
CauseMatrix RigProblem::restricted(CauseMatrix H) const {
  for (std::size_t k = 0; k < kRigCauses; ++k) {
    if (!is_left_out_[k]) continue;
    const auto i = static_cast<Eigen::Index>(k);
    H.row(i).setZero();
    H.col(i).setZero();
    H(i, i) = 1.0;
  }
  return H;
}

/// Of the values, to the least sum of squares.
CauseVector RigProblem::changeBy(Normal sum) const {
  for (std::size_t k = 0; k < kRigCauses; ++k) {
    if (is_left_out_[k]) sum.g[Eigen::Index(k)] = 0.0;
  }
  return restricted(sum.H).ldlt().solve(sum.g);
}

}  // namespace rotrocc
