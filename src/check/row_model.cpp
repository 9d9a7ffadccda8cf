#include "check/row_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <ceres/ceres.h>

#include "check/image_grid.h"
#include "check/windows.h"
#include "common/median.h"

namespace rotrocc {
namespace {

/// Significance below which a cause is left out.
constexpr double kSigmas = 3.0;

/// Standard deviations of the causes before anything is measured: those of a bad calibration. They
/// decide only what the rows do not.
constexpr RowCauses kPrior = {0.02, 0.02, 0.02, 0.03, 10.0, 0.1, 0.03};

constexpr double kLeastNoise_px = 0.02;

/// Residuals of more standard deviations count less: windows at edges, and wrong matches.
constexpr double kRobust = 0.7;

/// What matching leaves in a part of the image, where windows are alike.
constexpr double kMatching_px = 0.02;

/// sin and cos of small angles would do; these hold for any.
template <class T>
T rightRow(const StereoCamera& camera, const T* causes, const RowSample& sample) {
  // Of the point in the right camera: R_left_right^T (x, y, 1), R_left_right = Ry Rx Rz.
  using std::cos;
  using std::sin;
  const T x1 = cos(causes[kYaw]) * sample.x_right - sin(causes[kYaw]);
  const T z1 = sin(causes[kYaw]) * sample.x_right + cos(causes[kYaw]);
  const T y2 = cos(causes[kPitch]) * sample.y + sin(causes[kPitch]) * z1;
  const T z2 = -sin(causes[kPitch]) * sample.y + cos(causes[kPitch]) * z1;
  const T x3 = cos(causes[kRoll]) * x1 + sin(causes[kRoll]) * y2;
  const T y3 = -sin(causes[kRoll]) * x1 + cos(causes[kRoll]) * y2;
  const T x = x3 / z2;
  const T y = y3 / z2;
  const T seen = y * (1.0 + causes[kLens] * (x * x + y * y));
  return camera.fy * ((1.0 + causes[kFocal]) * seen - sample.y) + causes[kOffset] +
         causes[kTimeSkew] * sample.velocity_pxps;
}

struct PriorResidual {
  template <class T>
  bool operator()(const T* causes, T* residuals) const {
    for (std::size_t k = 0; k < kRowCauses; ++k) residuals[k] = causes[k] / kPrior[k];
    return true;
  }
};

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

struct RowProblem {
  const StereoCamera& camera;
  const std::vector<RowSample>& samples;
  const std::vector<std::size_t>& windows;
  RowCauses start = {};
  std::array<bool, kRowCauses> is_left_out = {};  ///< these count as zero
  double noise_px = 1.0;  ///< of the samples, that estimates weight them with

  struct RowResidual {
    const RowProblem& problem;
    const RowSample& sample;

    template <class T>
    bool operator()(const T* causes, T* residual) const {
      std::array<T, kRowCauses> used;
      for (std::size_t k = 0; k < kRowCauses; ++k) {
        used[k] = problem.is_left_out[k] ? T(0.0) : causes[k];
      }
      *residual =
          (rightRow(problem.camera, used.data(), sample) - sample.row_px) / problem.noise_px;
      return true;
    }
  };

  void setNoise(const RowCauses& causes) {
    std::vector<double> errors_px;
    for (const RowSample& sample : samples) {
      errors_px.push_back(std::abs(rowOf(camera, causes, sample) - sample.row_px));
    }
    noise_px = std::max(kDeviationOverMedian * median(errors_px), kLeastNoise_px);
  }

  /// The causes by the samples of all windows but one.
  RowCauses estimate(std::size_t left_out = kNone) const {
    RowCauses causes = start;
    ceres::Problem problem;
    fill(problem, causes, left_out);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.logging_type = ceres::SILENT;
    options.max_num_iterations = 20;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return causes;
  }

  /// Standard deviations by the noise of the samples alone.
  RowCauses formalSigmas(RowCauses causes) const {
    ceres::Problem problem;
    fill(problem, causes, kNone);
    ceres::Covariance::Options options;
    options.algorithm_type = ceres::DENSE_SVD;
    ceres::Covariance covariance(options);
    RowCauses sigmas;
    sigmas.fill(std::numeric_limits<double>::infinity());
    const std::vector<const double*> blocks = {causes.data()};
    if (!covariance.Compute(blocks, &problem)) return sigmas;
    std::array<double, kRowCauses * kRowCauses> values;
    covariance.GetCovarianceMatrix(blocks, values.data());
    for (std::size_t k = 0; k < kRowCauses; ++k) sigmas[k] = std::sqrt(values[k * kRowCauses + k]);
    return sigmas;
  }

  void fill(ceres::Problem& problem, RowCauses& causes, std::size_t left_out) const {
    using Cost = ceres::AutoDiffCostFunction<RowResidual, 1, kRowCauses>;
    using Prior = ceres::AutoDiffCostFunction<PriorResidual, kRowCauses, kRowCauses>;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (windows[i] == left_out) continue;
      problem.AddResidualBlock(new Cost(new RowResidual{*this, samples[i]}),
                               new ceres::CauchyLoss(kRobust),
                               causes.data());
    }
    problem.AddResidualBlock(new Prior(new PriorResidual), nullptr, causes.data());
  }
};

/// By which errors that the samples of a part of the image share, e.g. of a lens, increase standard
/// deviations of independent errors.
double sharedErrorFactor(const RowProblem& problem, const RowCauses& causes) {
  const StereoCamera& camera = problem.camera;
  const double noise_px = problem.noise_px;
  const ImageGrid grid(camera.width, camera.height);
  std::vector<std::vector<double>> remainders_px(grid.count());
  for (const RowSample& sample : problem.samples) {
    remainders_px[grid.of(sample.left_px.x, sample.left_px.y)].push_back(
        sample.row_px - rowOf(camera, causes, sample));
  }
  double squares = 0.0;
  double cells = 0.0;
  for (std::vector<double>& remainders : remainders_px) {
    if (remainders.size() < ImageGrid::kLeast) continue;
    const double variance =
        kMedianOverMean * kMedianOverMean * noise_px * noise_px / remainders.size();
    squares += std::pow(median(remainders), 2) - variance;
    cells += 1.0;
  }
  if (cells == 0.0) return 1.0;
  const double shared2 = std::max(squares / cells, kMatching_px * kMatching_px);
  const double per_cell = static_cast<double>(problem.samples.size()) / cells;
  return std::sqrt(1.0 + per_cell * shared2 / (noise_px * noise_px));
}

/// The cause to be left out next; kRowCauses if all are significant. Pitch goes before the row of
/// the principal point, which looks the same but for some hundredths of a pixel.
std::size_t weakestOf(const RowProblem& problem, const RowCauses& significances) {
  if (!problem.is_left_out[kPitch] && significances[kPitch] < kSigmas) return kPitch;
  std::size_t weakest = kRowCauses;
  double least = kSigmas;
  for (std::size_t k = 0; k < kRowCauses; ++k) {
    if (problem.is_left_out[k] || significances[k] >= least) continue;
    least = significances[k];
    weakest = k;
  }
  return weakest;
}

void addEffects(const StereoCamera& camera,
                const std::vector<RowSample>& samples,
                RowModel& model) {
  for (std::size_t k = 0; k < kRowCauses; ++k) {
    RowCauses alone = {};
    alone[k] = 0.1 * kPrior[k];
    double squares = 0.0;
    for (const RowSample& sample : samples) squares += std::pow(rowOf(camera, alone, sample), 2);
    const double by_unit = std::sqrt(squares / static_cast<double>(samples.size())) / alone[k];
    model.effects_px[k] = by_unit * std::abs(model.causes[k]);
    model.effect_sigmas_px[k] = by_unit * model.sigmas[k];
  }
}

}  // namespace

Eigen::Matrix3d rotationOf(const RowCauses& causes) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(causes[kYaw], Vector3d::UnitY()) *
          AngleAxisd(causes[kPitch], Vector3d::UnitX()) *
          AngleAxisd(causes[kRoll], Vector3d::UnitZ()))
      .toRotationMatrix();
}

double rowOf(const StereoCamera& camera, const RowCauses& causes, const RowSample& sample) {
  return rightRow(camera, causes.data(), sample);
}

RowModel fitRows(const StereoCamera& camera,
                 const std::vector<RowSample>& samples,
                 const std::vector<std::size_t>& windows,
                 std::size_t window_count) {
  RowModel model;
  if (samples.size() < kLeastSamples) {
    model.sigmas.fill(std::numeric_limits<double>::infinity());
    model.effect_sigmas_px = model.sigmas;
    return model;
  }
  RowProblem problem = {camera, samples, windows};
  problem.setNoise(problem.estimate());
  for (;;) {
    model.causes = problem.estimate();
    problem.start = model.causes;
    problem.setNoise(model.causes);
    const RowCauses formal = problem.formalSigmas(model.causes);
    std::vector<std::vector<double>> without;
    for (std::size_t w = 0; w < window_count; ++w) {
      const RowCauses causes = problem.estimate(w);
      without.emplace_back(causes.begin(), causes.end());
    }
    const std::vector<double> scatter = jackknifeSigmas(without);
    const double shared = sharedErrorFactor(problem, model.causes);
    RowCauses significances = {};
    for (std::size_t k = 0; k < kRowCauses; ++k) {
      if (problem.is_left_out[k]) continue;
      model.sigmas[k] = std::max(shared * formal[k], scatter[k]);
      significances[k] = std::abs(model.causes[k]) / model.sigmas[k];
    }
    const std::size_t weakest = weakestOf(problem, significances);
    if (weakest == kRowCauses) break;
    if (weakest == kPitch) model.may_be_pitch = significances[kOffset] < kSigmas;
    problem.is_left_out[weakest] = true;
    problem.start[weakest] = 0.0;
  }
  addEffects(camera, samples, model);
  return model;
}

}  // namespace rotrocc
