#include "check/sharpness.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace rotrocc {
namespace {

/// Power spectrum of the windowed patches, minus that of white noise.
struct Spectrum {
  cv::Mat_<float> power;
  double noise;  ///< that was subtracted
};

Spectrum spectrumOf(const ImagePatches& patches) {
  const cv::Size size = patches.areas.front().size();
  cv::Mat window;
  cv::createHanningWindow(window, size, CV_32F);
  cv::Mat_<float> power = cv::Mat_<float>::zeros(size);
  for (const cv::Rect& area : patches.areas) {
    cv::Mat patch, parts[2];
    patches.image(area).convertTo(patch, CV_32F);
    cv::dft(window.mul(patch - cv::mean(patch)), patch, cv::DFT_COMPLEX_OUTPUT);
    cv::split(patch, parts);
    power += parts[0].mul(parts[0]) + parts[1].mul(parts[1]);
  }
  const double noise = patches.noise_gray * patches.noise_gray * window.dot(window) *
                       static_cast<double>(patches.areas.size());
  return {power - noise, noise};
}

}  // namespace

double blurOfRight_px2(const ImagePatches& left, const ImagePatches& right) {
  constexpr double kMost_px2 = 16.0;
  constexpr double kOverNoise = 3.0;
  const Spectrum of_left = spectrumOf(left), of_right = spectrumOf(right);
  const int count = of_left.power.cols;
  // Sums over rings of about equal frequencies: of both powers, of w^2, and the number of bins.
  std::vector<cv::Vec4d> rings(static_cast<std::size_t>(count / 2 + 1), cv::Vec4d());
  for (int row = 0; row < count; ++row) {
    for (int column = 0; column < count; ++column) {
      const double radius =
          std::hypot(std::min(row, count - row), std::min(column, count - column));
      const auto ring = static_cast<std::size_t>(std::lround(radius));
      if (ring >= rings.size()) continue;
      const double w = 2.0 * CV_PI / count * radius;
      rings[ring] += cv::Vec4d(of_left.power(row, column), of_right.power(row, column), w * w, 1.0);
    }
  }
  // A Gaussian of variance v multiplies the power by exp(-v w^2): the slope over w^2. The window
  // spreads over the lowest frequencies.
  constexpr std::size_t kLeast = 2;
  const double least = kOverNoise * std::max(of_left.noise, of_right.noise);  // of a bin
  double sum = 0.0, sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, sum_xy = 0.0;
  for (std::size_t ring = kLeast; ring < rings.size(); ++ring) {
    const auto& [l, r, w2, bins] = rings[ring].val;
    if (std::min(l, r) < least * bins) break;
    const double x = w2 / bins;
    const double y = std::log(r / l);
    sum += bins;
    sum_x += bins * x;
    sum_y += bins * y;
    sum_xx += bins * x * x;
    sum_xy += bins * x * y;
  }
  const double slope = (sum * sum_xy - sum_x * sum_y) / (sum * sum_xx - sum_x * sum_x);
  return std::clamp(-slope, -kMost_px2, kMost_px2);
}

}  // namespace rotrocc
