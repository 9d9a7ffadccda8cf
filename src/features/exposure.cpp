#include "features/exposure.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/median.h"

namespace rotrocc {
namespace {

/// Sums over pairs of grey levels.
struct PairSums {
  std::int64_t count = 0;
  std::int64_t a = 0, b = 0, aa = 0, ab = 0, bb = 0;
};

/// Sums over pixels whose difference to the expected level is at most `most`. Neither saturated
/// pixels nor the black margins of rectified images tell the exposure.
PairSums sumsNear(const cv::Mat& from, const cv::Mat& to, const Exposure& expected, double most) {
  constexpr double kPixels = 1000.0;
  constexpr int kDarkest = 3;
  constexpr int kLightest = 250;
  const auto gain = static_cast<float>(expected.gain);
  const auto offset = static_cast<float>(expected.offset);
  const auto limit = static_cast<float>(most);
  const auto all = static_cast<double>(from.total());
  const int step_px = cvFloor(std::sqrt(all / kPixels)) | 1;  // odd, unlike periods of patterns
  PairSums sums;
  for (int y = 0; y < from.rows; y += step_px) {
    const auto* in_from = from.ptr<uchar>(y);
    const auto* in_to = to.ptr<uchar>(y);
    for (int x = 0; x < from.cols; x += step_px) {
      const int lighter = std::max(in_from[x], in_to[x]);
      const float difference =
          static_cast<float>(in_to[x]) - gain * static_cast<float>(in_from[x]) - offset;
      // Without branches, which would be mispredicted.
      const int counts = static_cast<int>(lighter >= kDarkest) &
                         static_cast<int>(lighter <= kLightest) &
                         static_cast<int>(std::abs(difference) <= limit);
      const int a = counts * in_from[x];
      const int b = counts * in_to[x];
      sums.count += counts;
      sums.a += a;
      sums.b += b;
      sums.aa += a * a;
      sums.ab += a * b;
      sums.bb += b * b;
    }
  }
  return sums;
}

constexpr int kHalfWindow = 5;

bool windowInside(const cv::Mat& image, const cv::Point& center) {
  return center.x >= kHalfWindow && center.x < image.cols - kHalfWindow &&
         center.y >= kHalfWindow && center.y < image.rows - kHalfWindow;
}

/// Variance of the grey levels of a window, times the square of its number of pixels.
double variance(const cv::Mat& image, const cv::Point& center) {
  constexpr int kPixels = (2 * kHalfWindow + 1) * (2 * kHalfWindow + 1);
  int sum = 0;
  int squares = 0;
  for (int y = center.y - kHalfWindow; y <= center.y + kHalfWindow; ++y) {
    const auto* row = image.ptr<uchar>(y) + center.x;
    for (int x = -kHalfWindow; x <= kHalfWindow; ++x) {
      sum += row[x];
      squares += row[x] * row[x];
    }
  }
  return kPixels * squares - sum * sum;
}

}  // namespace

Exposure compareExposures(const cv::Mat& from, const cv::Mat& to) {
  constexpr int kFits = 3;
  constexpr int kLeastPixels = 50;
  constexpr double kLeastVariance = 25.0;
  Exposure exposure;
  double most = 2.0 * 255.0;
  for (int i = 0; i < kFits; ++i) {
    const PairSums sums = sumsNear(from, to, exposure, most);
    if (sums.count < kLeastPixels) return {};
    const auto pixels = static_cast<double>(sums.count);
    const double mean_a = static_cast<double>(sums.a) / pixels;
    const double mean_b = static_cast<double>(sums.b) / pixels;
    const double aa = static_cast<double>(sums.aa) / pixels - mean_a * mean_a;
    const double ab = static_cast<double>(sums.ab) / pixels - mean_a * mean_b;
    const double bb = static_cast<double>(sums.bb) / pixels - mean_b * mean_b;
    if (aa < kLeastVariance || bb < kLeastVariance) return {};
    // The ratio of the deviations, because a regression is too flat: parallax is noise in both.
    exposure.gain = std::sqrt(bb / aa);
    exposure.offset = mean_b - exposure.gain * mean_a;
    // The next fit leaves out what is beyond one sigma: edges, and what only one image shows.
    most = std::sqrt(std::max(2.0 * (bb - exposure.gain * ab), 1.0));
  }
  return exposure;
}

void WindowGain::add(const cv::Mat& from,
                     const cv::Point2f& from_px,
                     const cv::Mat& to,
                     const cv::Point2f& to_px) {
  // At whole pixels, because interpolation lowers the contrast.
  const cv::Point a(cvRound(from_px.x), cvRound(from_px.y));
  const cv::Point b(cvRound(to_px.x), cvRound(to_px.y));
  if (!windowInside(from, a) || !windowInside(to, b)) return;
  const double before = variance(from, a);
  const double after = variance(to, b);
  if (before > 0.0 && after > 0.0) gains_.push_back(static_cast<float>(std::sqrt(after / before)));
}

double WindowGain::median(double otherwise) {
  constexpr std::size_t kLeast = 8;
  return gains_.size() < kLeast ? otherwise : rotrocc::median(gains_);
}

double beyondNoise(double gain, double noise) {
  return std::abs(std::log(gain)) < noise ? 1.0 : gain;
}

}  // namespace rotrocc
