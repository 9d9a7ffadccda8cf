#include "simulation/rendering/sensor.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulation/counter_random.h"
#include "simulation/rows.h"

namespace rotrocc {
namespace {

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

/// Standard deviation of the light that a pixel measures, as a share of white.
double lightSigma(const Sensor& sensor, double light) {
  if (sensor.full_well_e <= 0.0) return 0.0;
  const double read = sensor.read_noise_e / sensor.full_well_e;
  return std::sqrt(light / sensor.full_well_e + read * read);
}

}  // namespace

Sensor Exposure::of(Sensor sensor) const {
  constexpr double kFullWell_e = 4000.0;
  constexpr double kReadNoise_e = 8.0;
  if (gain <= 1.0) return sensor;
  if (sensor.full_well_e <= 0.0) {
    sensor.full_well_e = kFullWell_e;
    sensor.read_noise_e = kReadNoise_e;
  }
  sensor.full_well_e /= gain;
  return sensor;
}

cv::Mat develop(const cv::Mat& brightness,
                const Sensor& sensor,
                double gain,
                std::uint64_t noise_key) {
  cv::Mat image(brightness.size(), CV_8UC1);
  const cv::Point2d centre(0.5 * (image.cols - 1), 0.5 * (image.rows - 1));
  const double corner_squared = centre.ddot(centre);
  const std::vector<float> response = responseTable();
  forEachRow(image.rows, [&](int y) {
    for (int x = 0; x < image.cols; ++x) {
      const cv::Point2d off = cv::Point2d(x, y) - centre;
      const double lost = sensor.vignetting * off.ddot(off) / corner_squared;
      const double light = gain * (1.0 - lost) * brightness.at<float>(y, x);
      const auto pixel = static_cast<std::uint64_t>(y) * image.cols + x;
      const double random = gaussian(randomBits(noise_key + pixel));
      const double measured = std::clamp(light + lightSigma(sensor, light) * random, 0.0, 1.0);
      const auto step = static_cast<std::size_t>(measured * kResponseSteps + 0.5);
      image.at<uchar>(y, x) =
          cv::saturate_cast<uchar>(response[step] + sensor.noise_sigma * random);
    }
  });
  return image;
}

}  // namespace rotrocc
