#include "check/disparity_check.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "check/image_grid.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Disparities that a motion determines worse say nothing.
constexpr double kMostSigma_px = 2.0;

/// What the bias may be instead; empty if it is not.
std::string orYaw(const StereoCamera& camera, const RigModel& model) {
  if (model.horizontal != TurnOrShift::kEither || model.values[kBias] == 0.0) return "";
  const double per_px = -180.0 / M_PI / camera.fx;
  return " in the middle of the image, by the principal point, or by a yaw of the right camera "
         "of " +
         toText(Estimate{per_px * model.values[kBias], -per_px * model.sigmas[kBias]}, "deg") +
         ": the images do not show which";
}

/// By the motion as the odometry has it.
void addMap(const StereoCamera& camera, const std::vector<PairSamples>& pairs, RigReport& report) {
  const ImageGrid grid(camera.width, camera.height);
  struct Cell {
    double count = 0.0, weights = 0.0, weighted_px = 0.0, squares = 0.0;
  };
  std::vector<Cell> cells(grid.count());
  for (const PairSamples& pair : pairs) {
    for (const RigSample& sample : pair.samples) {
      const double information = sample.flow_by_disparity.squaredNorm();
      const double sigma_px = pair.flow_noise_px / std::sqrt(information);
      if (!(sigma_px < kMostSigma_px)) continue;
      const double error_px = sample.flow_by_disparity.dot(sample.flow_px) / information;
      Cell& cell = cells[grid.of(sample.left_px.x, sample.left_px.y)];
      const double weight = 1.0 / (sigma_px * sigma_px);
      cell.count += 1.0;
      cell.weights += weight;
      cell.weighted_px += weight * error_px;
      cell.squares += weight * weight * error_px * error_px;
    }
  }
  ReportTable table = {"disparity_map", "x_px,y_px,count,bias_px,sigma_px", {}};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Cell& cell = cells[i];
    if (cell.count < ImageGrid::kLeast) continue;
    const cv::Point2d center = grid.center(i);
    const double mean_px = cell.weighted_px / cell.weights;
    table.rows.push_back(
        {center.x, center.y, cell.count, mean_px, std::sqrt(cell.squares) / cell.weights});
  }
  report.tables.push_back(std::move(table));
}

}  // namespace

bool checkDisparities(const StereoCamera& camera,
                      const std::vector<PairSamples>& pairs,
                      const RigModel& model,
                      const Windows& windows,
                      double applied_px,
                      RigReport& report) {
  if (!std::isfinite(model.sigmas[kBias])) return true;
  const double typical_px = model.typical_disparity_px;
  const Estimate bias_px = {model.values[kBias], model.sigmas[kBias]};
  const double fB = camera.fx * camera.baseline_m;
  const auto scaleAt = [&](double depth_m) {
    return fixedText(100.0 * bias_px.value * depth_m / fB, 1) + " % at " + toText(depth_m) + " m";
  };
  report.add(
      {"disparities",
       "bias of the disparities",
       toText(bias_px, "px") + " are missing" + orYaw(camera, model) + "; depths are wrong by " +
           scaleAt(5.0) + ", " + scaleAt(10.0) + ", " + scaleAt(20.0),
       "without a correction " + fixedText(std::abs(100.0 * bias_px.value / typical_px), 1) +
           " m in 100 m, at the disparity of the mean depth, " + fixedText(typical_px, 1) +
           " px; the odometry corrects " + fixedText(applied_px, 2) + " px of it",
       "`rosrun rotrocc check_rig RECORDING --write-camera-info DIR` writes the corrected "
       "calibration; obstacle maps of the same cameras need it, too"},
      {bias_px.value / typical_px, bias_px.sigma / typical_px, kAcceptable * kFixScale, kFixScale});
  const Estimate motion_px = scatterBeyondNoise(model.biases_px);
  report.add({"disparities",
              "bias over time",
              "moves by " + fixedText(motion_px.value, 2) + " px (rms)",
              "a rig that bends has another scale at each time",
              "mount both cameras on one stiff bar"},
             {motion_px.value / typical_px,
              motion_px.sigma / typical_px,
              kAcceptable * kFixScale,
              kFixScale});
  addMap(camera, pairs, report);
  ReportTable course = {"bias_time", "time_s,bias_px,sigma_px", {}};
  for (std::size_t w = 0; w < model.biases_px.size(); ++w) {
    const auto& [value, sigma] = model.biases_px[w];
    if (std::isfinite(sigma)) course.rows.push_back({windows.middle_s(w), value, sigma});
  }
  report.tables.push_back(std::move(course));
  return motion_px.value < std::max(kFixScale * typical_px, 0.5 * std::abs(bias_px.value));
}

}  // namespace rotrocc
