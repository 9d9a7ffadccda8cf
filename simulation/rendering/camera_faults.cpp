#include "simulation/rendering/camera_faults.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "simulation/counter_random.h"

namespace rotrocc {
namespace {

constexpr int kFramesPerExposure = 12;

void requireRange(const std::string& name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw std::invalid_argument(name + " is " + std::to_string(value) + ": choose it from " +
                              std::to_string(low) + " to " + std::to_string(high));
}

}  // namespace

void CameraFaults::check() const {
  requireRange("disparity bias [px]", disparity_bias_px, -20.0, 20.0);
  requireRange("rotation of the right camera [rad]", right_rotation_rad.norm(), 0.0, 0.2);
  requireRange("row offset [px]", row_offset_px, -20.0, 20.0);
  requireRange("time skew [s]", time_skew_s, -0.1, 0.1);
  requireRange("noise [grey levels]", sensor.noise_sigma, 0.0, 50.0);
  requireRange("vignetting", sensor.vignetting, 0.0, 1.0);
  requireRange("exposure jumps", exposure_jumps, 0.0, 4.0);
  requireRange("motion blur [s]", motion_blur_s, 0.0, 0.1);
}

Eigen::Isometry3d CameraFaults::rightCamera(const StereoCamera& camera) const {
  Eigen::Isometry3d T_left_right = Eigen::Isometry3d::Identity();
  T_left_right.translation().x() = camera.baseline_m;
  T_left_right.rotate(Eigen::AngleAxisd(right_rotation_rad[2], Eigen::Vector3d::UnitY()));
  T_left_right.rotate(Eigen::AngleAxisd(right_rotation_rad[1], Eigen::Vector3d::UnitX()));
  T_left_right.rotate(Eigen::AngleAxisd(right_rotation_rad[0], Eigen::Vector3d::UnitZ()));
  return T_left_right;
}

double jumpGain(const CameraFaults& faults, int frame, std::uint64_t seed) {
  const auto jump = static_cast<std::uint64_t>(frame / kFramesPerExposure);
  const double exponent = 2.0 * randomUniform(seed, 0xE59, jump) - 1.0;
  return std::pow(1.0 + faults.exposure_jumps, exponent);
}

}  // namespace rotrocc
