#include "check/disparity_check.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "check/image_grid.h"
#include "check/robust_fit.h"
#include "common/median.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

constexpr std::size_t kPerPair = 100;

/// Limits of the error of the scale, at the median disparity, when nobody corrects the bias.
constexpr double kAcceptableScale = 0.01;
constexpr double kFixScale = 0.03;

/// Disparities that a motion determines worse say nothing.
constexpr double kMostSigma_px = 2.0;

}  // namespace

void DisparityCheck::observe(const CheckedPair& pair) {
  camera_ = pair.camera;
  if (!pair.result.hasMotion()) return;
  bias_ = pair.result.disparity_bias;
  biases_px_.push_back({pair.time_s, bias_.estimated_px});
  bias_sigmas_px_.push_back(bias_.sigma_px);
  const std::size_t step = std::max<std::size_t>(1, pair.features.size() / kPerPair);
  for (std::size_t i = 0; i < pair.features.size(); i += step) {
    if (pair.inliers[i] == 0) continue;
    disparities_px_.push_back(pair.features[i].disparity_px - camera_.disparityAtInfinity());
    measure(pair, i);
  }
}

/// By the flow: a step of the disparity that moves the predicted pixel to the measured one.
void DisparityCheck::measure(const CheckedPair& pair, std::size_t index) {
  constexpr double kStep_px = 0.1;
  const Correspondence& feature = pair.features[index];
  const Eigen::Isometry3d& T = pair.result.T_keyframe_cur.T;
  const double corrected_px = pair.result.disparity_bias.applied_px;
  const Eigen::Vector3d ray = camera_.ray(feature.cur_px);
  const auto keyframe_px = [&](double change_px) -> Eigen::Vector2d {
    const double depth_m = camera_.depth(feature.disparity_px + corrected_px + change_px);
    return camera_.project(T * (depth_m * ray));
  };
  const double before_px = feature.disparity_px + corrected_px - camera_.disparityAtInfinity();
  if (before_px < 10.0 * kStep_px) return;
  const Eigen::Vector2d at = keyframe_px(0.0);
  const Eigen::Vector2d slope = (keyframe_px(kStep_px) - at) / kStep_px;
  const Eigen::Vector2d residual = feature.keyframe_px - at;
  const double information = slope.squaredNorm();
  const double sigma_px = pair.result.flow_noise_px / std::sqrt(information);
  if (!(sigma_px < kMostSigma_px)) return;
  errors_.push_back(
      {static_cast<float>(feature.cur_px.x()),
       static_cast<float>(feature.cur_px.y()),
       static_cast<float>((feature.cur_px.x() - feature.disparity_px - camera_.cx_right) /
                          camera_.fx),
       static_cast<float>(slope.dot(residual) / information + corrected_px),
       static_cast<float>(sigma_px)});
}

void DisparityCheck::report(const Windows& windows, RigReport& report) const {
  if (biases_px_.empty()) return;
  std::vector<double> disparities_px = disparities_px_;
  const double typical_px = disparities_px.empty() ? 0.0 : median(disparities_px);
  const double fB = camera_.fx * camera_.baseline_m;
  const double bias_px = bias_.estimated_px;
  const auto scaleAt = [&](double depth_m) {
    return fixedText(100.0 * bias_px * depth_m / fB, 1) + " % at " + toText(depth_m) + " m";
  };
  report.add(
      {"disparities",
       "bias of the disparities",
       toText(Estimate{bias_px, bias_.sigma_px}, "px") + " are missing; depths are wrong by " +
           scaleAt(5.0) + ", " + scaleAt(10.0) + ", " + scaleAt(20.0),
       "without a correction " + fixedText(std::abs(100.0 * bias_px / typical_px), 1) +
           " m in 100 m, at the typical disparity of " + fixedText(typical_px, 1) +
           " px; the odometry corrects " + fixedText(bias_.applied_px, 2) + " px of it",
       "`rosrun rotrocc check_rig RECORDING --write-camera-info DIR` writes the corrected "
       "calibration; obstacle maps of the same cameras need it, too"},
      {bias_px / typical_px, bias_.sigma_px / typical_px, kAcceptableScale, kFixScale});

  const auto [motion_px, known_px] = motionOfBias();
  report.add({"disparities",
              "bias over time",
              "moves by " + fixedText(motion_px, 2) + " px (rms)",
              "a rig that bends has another scale at each time",
              "mount both cameras on one stiff bar"},
             {motion_px / typical_px,
              known_px / std::sqrt(static_cast<double>(windows.count())) / typical_px,
              kAcceptableScale,
              kFixScale});
  addMap(report);
  ReportTable course = {"bias_time", "time_s,bias_px,sigma_px", {}};
  for (std::size_t i = 0; i < biases_px_.size(); ++i) {
    course.rows.push_back({biases_px_[i].time_s, biases_px_[i].value, bias_sigmas_px_[i]});
  }
  report.tables.push_back(std::move(course));
}

/// A right camera that is turned by a small yaw sees x at x - yaw (1 + x^2), in normalized
/// coordinates. The constant part is one with the bias, and a slope with the focal length.
Estimate DisparityCheck::keystone_rad() const {
  std::vector<Eigen::Vector3d> rows;
  std::vector<double> values;
  for (const Error& error : errors_) {
    const double x = error.x_right;
    rows.push_back(Eigen::Vector3d(1.0, x, -camera_.fx * x * x) / error.sigma_px);
    values.push_back(error.correction_px / error.sigma_px);
  }
  const RobustFit fit = fitRobustly(rows, values);
  return {fit.parameters.z(), fit.sigmas.z()};
}

/// How far the bias moves around its mean, and how well it is known: both mean squares over the
/// pairs, square roots [px]. What is not known of it counts as no motion.
std::pair<double, double> DisparityCheck::motionOfBias() const {
  const auto count = static_cast<double>(biases_px_.size());
  double mean_px = 0.0;
  for (const TimedValue& bias : biases_px_) mean_px += bias.value / count;
  double squares = 0.0;
  double variance = 0.0;
  for (std::size_t i = 0; i < biases_px_.size(); ++i) {
    squares += std::pow(biases_px_[i].value - mean_px, 2) / count;
    variance += bias_sigmas_px_[i] * bias_sigmas_px_[i] / count;
  }
  return {std::sqrt(std::max(squares - variance, 0.0)), std::sqrt(variance)};
}

void DisparityCheck::addMap(RigReport& report) const {
  const ImageGrid grid(camera_.width, camera_.height);
  struct Cell {
    double count = 0.0, weights = 0.0, weighted_px = 0.0, squares = 0.0;
  };
  std::vector<Cell> cells(grid.count());
  for (const Error& error : errors_) {
    Cell& cell = cells[grid.of(error.x_px, error.y_px)];
    const double weight = 1.0 / (error.sigma_px * error.sigma_px);
    cell.count += 1.0;
    cell.weights += weight;
    cell.weighted_px += weight * error.correction_px;
    cell.squares += weight * weight * error.correction_px * error.correction_px;
  }
  ReportTable table = {"disparity_map", "x_px,y_px,count,bias_px,sigma_px", {}};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Cell& cell = cells[i];
    if (cell.count < ImageGrid::kLeast) continue;
    const cv::Point2d centre = grid.centre(i);
    const double mean_px = cell.weighted_px / cell.weights;
    table.rows.push_back(
        {centre.x, centre.y, cell.count, mean_px, std::sqrt(cell.squares) / cell.weights});
  }
  report.tables.push_back(std::move(table));
}

}  // namespace rotrocc
