#include "simulation/rendering/camera_faults.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "simulation/counter_random.h"
#include "simulation/rows.h"

namespace rotrocc {
namespace {

constexpr int kFramesPerExposure = 12;
constexpr double kResponse = 0.8;  // exponent of the camera response
constexpr int kResponseSteps = 4096;

/// Grey levels for brightness 0 ... 1 in equal steps.
std::vector<float> responseTable() {
  std::vector<float> table;
  for (int i = 0; i <= kResponseSteps; ++i) {
    table.push_back(
        static_cast<float>(255.0 * std::pow(static_cast<double>(i) / kResponseSteps, kResponse)));
  }
  return table;
}

double exposureGain(const CameraFaults& faults, int frame, std::uint64_t seed) {
  const auto jump = static_cast<std::uint64_t>(frame / kFramesPerExposure);
  const double exponent = 2.0 * randomUniform(seed, 0xE59, jump) - 1.0;
  return std::pow(1.0 + faults.exposure_jumps, exponent);
}

/// Four independent parts of a random number add up to one that is nearly Gaussian, with a standard
/// deviation of 1.
double gaussian(std::uint64_t bits) {
  int sum = 0;
  for (int i = 0; i < 4; ++i) sum += static_cast<int>((bits >> (16 * i)) & 0xFFFF);
  constexpr double kMean = 4.0 * 32767.5;
  constexpr double kSigma = 37837.2;  // 65536 * sqrt(4 / 12)
  return (sum - kMean) / kSigma;
}

void requireRange(const std::string& name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw std::invalid_argument(name + " is " + std::to_string(value) + ": choose it from " +
                              std::to_string(low) + " to " + std::to_string(high));
}

}  // namespace

void CameraFaults::check() const {
  requireRange("disparity bias [px]", disparity_bias_px, -20.0, 20.0);
  requireRange("rotation of the right camera [rad]", right_rotation_rad.norm(), 0.0, 0.2);
  requireRange("time skew [s]", time_skew_s, -0.1, 0.1);
  requireRange("noise [grey levels]", noise_sigma, 0.0, 50.0);
  requireRange("vignetting", vignetting, 0.0, 1.0);
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

cv::Mat develop(const cv::Mat& brightness,
                const CameraFaults& faults,
                const ImageNumber& number,
                std::uint64_t seed) {
  cv::Mat image(brightness.size(), CV_8UC1);
  const double gain = exposureGain(faults, number.frame, seed);
  const auto stream = 2 * static_cast<std::uint64_t>(number.frame) + (number.right ? 1 : 0);
  const std::uint64_t key = randomBits(seed, 0x4015E, stream);
  const cv::Point2d centre(0.5 * (image.cols - 1), 0.5 * (image.rows - 1));
  const double corner_squared = centre.ddot(centre);
  const std::vector<float> response = responseTable();
  forEachRow(image.rows, [&](int y) {
    for (int x = 0; x < image.cols; ++x) {
      const cv::Point2d off = cv::Point2d(x, y) - centre;
      const double lost = faults.vignetting * off.ddot(off) / corner_squared;
      const double light = std::min(1.0, gain * (1.0 - lost) * brightness.at<float>(y, x));
      const auto pixel = static_cast<std::uint64_t>(y) * image.cols + x;
      const double noise = faults.noise_sigma * gaussian(randomBits(key + pixel));
      const auto step = static_cast<std::size_t>(light * kResponseSteps + 0.5);
      image.at<uchar>(y, x) = cv::saturate_cast<uchar>(response[step] + noise);
    }
  });
  return image;
}

}  // namespace rotrocc
