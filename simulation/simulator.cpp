#include "simulation/simulator.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <opencv2/core/utility.hpp>

#include "simulation/counter_random.h"
#include "simulation/each_row.h"
#include "simulation/gyroscope.h"

namespace rotrocc {
namespace {

void requireRange(const std::string& name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw std::invalid_argument(name + " is " + std::to_string(value) + ": choose it from " +
                              std::to_string(low) + " to " + std::to_string(high));
}

SimulationOptions checked(const SimulationOptions& options) {
  options.camera.check();
  const CameraFaults& faults = options.faults;
  requireRange("disparity bias [px]", faults.disparity_bias_px, -20.0, 20.0);
  requireRange("rotation of the right camera [rad]", faults.right_rotation_rad.norm(), 0.0, 0.2);
  requireRange("row offset [px]", faults.row_offset_px, -20.0, 20.0);
  requireRange("focal length of the right camera", faults.right_focal_ratio, 0.5, 2.0);
  requireRange("time skew [s]", faults.time_skew_s, -0.1, 0.1);
  requireRange("noise [gray levels]", faults.noise_sigma, 0.0, 50.0);
  requireRange("motion blur [s]", faults.motion_blur_s, 0.0, 0.1);
  requireRange("share of moving cars", options.moving_share, 0.0, 1.0);
  requireRange("rate [Hz]", options.rate_hz, 1e-3, 1000.0);
  return options;
}

std::optional<UnrectifiedRig> rigWithLens(const SimulationOptions& options) {
  if (options.lens.empty()) return std::nullopt;
  return unrectifiedRig(options.camera, options.lens);
}

std::vector<std::int64_t> frameStamps(const Scenario& scenario, const SimulationOptions& options) {
  std::vector<std::int64_t> stamps_ns = scenario.stamps_ns;
  if (stamps_ns.empty()) {
    for (int i = 0; i <= scenario.drive->duration_s() * options.rate_hz; ++i) {
      stamps_ns.push_back(std::llround(1e9 * i / options.rate_hz));
    }
  }
  const auto frames = static_cast<std::size_t>(std::max(0, options.frames));
  if (frames > 0 && frames < stamps_ns.size()) stamps_ns.resize(frames);
  return stamps_ns;
}

constexpr double kVignetting = 0.15;  // relative loss of light in the corners
constexpr double kResponse = 0.8;     // exponent of the camera response
constexpr int kResponseSteps = 4096;

/// Gray levels for brightness 0 ... 1 in equal steps.
std::vector<float> responseTable() {
  std::vector<float> table;
  for (int i = 0; i <= kResponseSteps; ++i) {
    table.push_back(
        static_cast<float>(255.0 * std::pow(static_cast<double>(i) / kResponseSteps, kResponse)));
  }
  return table;
}

/// Converts brightness (CV_32FC1, 1 is white) to a CV_8UC1 image with vignetting and Gaussian
/// noise, independent for each pixel. The same key gives the same bytes for any number of threads.
cv::Mat develop(const cv::Mat& brightness, double noise_sigma, std::uint64_t noise_key) {
  cv::Mat image(brightness.size(), CV_8UC1);
  const cv::Point2d center(0.5 * (image.cols - 1), 0.5 * (image.rows - 1));
  const double corner_squared = center.ddot(center);
  const std::vector<float> response = responseTable();
  eachRow(image.rows, [&](int y) {
    for (int x = 0; x < image.cols; ++x) {
      const cv::Point2d off = cv::Point2d(x, y) - center;
      const double lost = kVignetting * off.ddot(off) / corner_squared;
      const double light = std::clamp((1.0 - lost) * brightness.at<float>(y, x), 0.0, 1.0);
      const auto pixel = static_cast<std::uint64_t>(y) * image.cols + x;
      const auto step = static_cast<std::size_t>(light * kResponseSteps + 0.5);
      image.at<uchar>(y, x) = cv::saturate_cast<uchar>(
          response[step] + noise_sigma * gaussian(randomBits(noise_key + pixel)));
    }
  });
  return image;
}

}  // namespace

Eigen::Isometry3d CameraFaults::rightCamera(const StereoCamera& camera) const {
  Eigen::Isometry3d T_left_right = Eigen::Isometry3d::Identity();
  T_left_right.translation().x() = camera.baseline_m;
  T_left_right.rotate(Eigen::AngleAxisd(right_rotation_rad[2], Eigen::Vector3d::UnitY()));
  T_left_right.rotate(Eigen::AngleAxisd(right_rotation_rad[1], Eigen::Vector3d::UnitX()));
  T_left_right.rotate(Eigen::AngleAxisd(right_rotation_rad[0], Eigen::Vector3d::UnitZ()));
  return T_left_right;
}

Simulator::Simulator(const Scenario& scenario, const SimulationOptions& options)
    : options_(checked(options)),
      unrectified_(rigWithLens(options)),
      drive_(scenario.drive),
      world_(scenario.world),
      traffic_(scenario.traffic, *drive_, world_, options.moving_share, options.seed),
      stamps_ns_(frameStamps(scenario, options)) {}

Eigen::Isometry3d Simulator::pose(int index) const {
  return drive_->pose(time_s(0)).inverse() * drive_->pose(time_s(index));
}

std::vector<GyroSample> Simulator::gyroscope() const {
  return simulateGyroscope(*drive_, stamps_ns_.front(), stamps_ns_.back(), options_.noise_seed);
}

PixelRays Simulator::rays(bool right) const {
  PixelRays rays = {options_.camera, {}};
  if (right) rays.pinhole.cx = options_.camera.cx_right;
  if (unrectified_) rays = (*unrectified_)[right ? 1 : 0].rays;
  if (!right) return rays;
  const double scale = rays.pinhole.fx / options_.camera.fx;
  rays.pinhole.cx -= scale * options_.faults.disparity_bias_px;
  rays.pinhole.cy += scale * options_.faults.row_offset_px;
  rays.pinhole.fx *= options_.faults.right_focal_ratio;
  rays.pinhole.fy *= options_.faults.right_focal_ratio;
  return rays;
}

Picture Simulator::look(double time_s, bool right) const {
  Eigen::Isometry3d T_world_camera = drive_->pose(time_s);
  if (right) T_world_camera = T_world_camera * options_.faults.rightCamera(options_.camera);
  return rotrocc::render(world_, traffic_.at(time_s), rays(right), T_world_camera);
}

/// With the depth at the stamp, also in motion blur.
Picture Simulator::exposed(double time_s, bool right) const {
  constexpr int kSteps = 24;  // a step for each pixel of 24 px of blur
  Picture picture = look(time_s, right);
  if (options_.faults.motion_blur_s <= 0.0) return picture;
  picture.brightness = 0.0;
  for (int step = 0; step < kSteps; ++step) {
    const double shift = (step + 0.5) / kSteps - 0.5;
    picture.brightness +=
        look(time_s + shift * options_.faults.motion_blur_s, right).brightness / kSteps;
  }
  return picture;
}

cv::Mat Simulator::developed(const cv::Mat& brightness, int index, bool right) const {
  const std::uint64_t image = 2 * static_cast<std::uint64_t>(index) + (right ? 1 : 0);
  return develop(
      brightness, options_.faults.noise_sigma, randomBits(options_.noise_seed, 0x4015E, image));
}

SimulatedFrame Simulator::render(int index) const {
  const Picture left = exposed(time_s(index), false);
  SimulatedFrame frame;
  frame.pair.stamp_ns = stamp_ns(index);
  frame.pair.left = developed(left.brightness, index, false);
  frame.pair.right = renderRight(index);
  if (!unrectified_) frame.depth = left.depth;
  return frame;
}

cv::Mat Simulator::renderRight(int index) const {
  const Picture right = exposed(time_s(index) + options_.faults.time_skew_s, true);
  return developed(right.brightness, index, true);
}

}  // namespace rotrocc
