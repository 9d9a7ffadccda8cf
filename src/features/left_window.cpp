#include "features/left_window.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>

#include "features/patch.h"
#include "features/stereo_matcher.h"

namespace rotrocc {
namespace {

using W = CorrelationWindow;

constexpr int kPixels = W::kSide * W::kSide;

/// Largest cost of a match: either window explains half of the variance of the other, rho^2 = 1/2.
constexpr double kMaxCost = 0.29;

/// Costs within this distance [px] of the minimum are its slopes.
constexpr int kSlope = 2;

/// The best match costs at most this share of its competitor: 0.92 times as long a difference.
constexpr double kUniqueness = 0.85;

/// Largest cost of a part for the whole window to be compared, where `min_cost` is the lowest cost
/// of a part. With twice the margin, the same matches are found.
float partLimit(float min_cost) {
  return 1.25F * min_cost + 0.05F;
}

/// Variance of rounding to whole grey levels. It limits the correlation of windows without texture.
constexpr double kRounding = 1.0 / 12.0;

/// Offset of the minimum of the parabola through the costs at -1, 0 and 1.
float subPixelOffset(double before, double at, double after) {
  const double curvature = before - 2.0 * at + after;
  if (!(curvature > 0.0)) return 0.0F;
  return static_cast<float>(std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5));
}

}  // namespace

LeftWindow::LeftWindow(const Kernels& kernels, const cv::Mat& left, const cv::Point& pixel)
    : kernels_(kernels), unit2_(1.0) {
  kernels.widenRows(left.ptr<uchar>(pixel.y - kHalf) + pixel.x - kHalf,
                    static_cast<std::ptrdiff_t>(left.step),
                    W::kStride,
                    values_,
                    W::kStride);
  describe();
}

LeftWindow::LeftWindow(const Kernels& kernels, const cv::Mat& left, const cv::Point2f& pixel)
    : kernels_(kernels), unit2_(1 << 2 * W::kSampleBits) {
  kernels.sampleRows(patchAt(left, pixel, kHalf), W::kStride, values_, W::kStride);
  describe();
}

void LeftWindow::describe() {
  for (int y = 0; y < W::kSide; ++y) {
    std::fill_n(values_ + y * W::kStride + W::kSide, W::kStride - W::kSide, std::int16_t{0});
  }
  const ProductSums own = kernels_.multiplyWindow(values_, values_, W::kStride);
  sum_ = own.b;
  variance_ = varianceOf(kPixels, own.b, own.bb);
}

/// Times the square of the number of values.
double LeftWindow::varianceOf(double count, double sum, double squares) const {
  return count * squares - sum * sum + count * count * kRounding * unit2_;
}

LeftWindow::Compared LeftWindow::compare(const std::int16_t* strip, int stride) const {
  const ProductSums sums = kernels_.multiplyWindow(values_, strip, stride);
  const double variance = varianceOf(kPixels, sums.b, sums.bb);
  const double covariance = static_cast<double>(kPixels) * sums.ab - double{sum_} * sums.b;
  return {1.0 - covariance / std::sqrt(variance_ * variance), variance};
}

RowMatch LeftWindow::refined(int column,
                             const Compared& before,
                             const Compared& at,
                             const Compared& after) const {
  return {static_cast<float>(column) + subPixelOffset(before.cost, at.cost, after.cost),
          std::sqrt(at.variance / variance_)};
}

RowMatch LeftWindow::searchRow(const std::int16_t* strip,
                               int stride,
                               int count,
                               RowBuffers& buffers) const {
  buffers.scratch.resize(static_cast<std::size_t>(W::scratchOf(count)));
  buffers.correlations.resize(static_cast<std::size_t>(count + kMaxShorts));
  float* const correlations = buffers.correlations.data();
  constexpr auto kNoise = static_cast<float>(W::kPartPixels * W::kPartPixels * kRounding);
  const float highest = kernels_.correlateParts(
      values_, strip, stride, count, kNoise, buffers.scratch.data(), correlations);
  if (!(highest > 0.0F)) return {};
  const float max_cost = partLimit(1.0F - std::sqrt(highest));
  const float min_correlation = max_cost < 1.0F ? (1.0F - max_cost) * (1.0F - max_cost) : 0.0F;
  buffers.peaks.resize(static_cast<std::size_t>(count));
  const int peaks =
      kernels_.findPeaks(correlations, 0, count - 2, 1, min_correlation, buffers.peaks.data());
  buffers.costs.resize(static_cast<std::size_t>(peaks));
  int best = -1;
  Compared of_best = {2.0, 0.0};
  for (int i = 0; i < peaks; ++i) {
    const int column = ++buffers.peaks[i];  // it was that of the first neighbour
    const Compared compared = compare(strip + column, stride);
    buffers.costs[i] = compared.cost;
    if (compared.cost >= of_best.cost) continue;
    of_best = compared;
    best = column;
  }
  if (best < 0) return {};
  Compared before = compare(strip + best - 1, stride);
  Compared after = compare(strip + best + 1, stride);
  if (before.cost < of_best.cost && before.cost <= after.cost && best >= 2) {
    --best;
    after = of_best;
    of_best = before;
    before = compare(strip + best - 1, stride);
  } else if (after.cost < of_best.cost && best + 2 < count) {
    ++best;
    before = of_best;
    of_best = after;
    after = compare(strip + best + 1, stride);
  }
  if (of_best.cost > kMaxCost) return {};
  for (int i = 0; i < peaks; ++i) {
    const bool competes = std::abs(buffers.peaks[i] - best) > kSlope;
    if (competes && of_best.cost >= kUniqueness * buffers.costs[i]) return {};
  }
  return refined(best, before, of_best, after);
}

RowMatch LeftWindow::searchNear(const std::int16_t* strip, int stride, int count) const {
  constexpr int kMaxCount = 2 * StereoMatcher::kNearRadius_px + 3;
  Compared all[kMaxCount];
  int best = 0;
  for (int k = 0; k < count; ++k) {
    all[k] = compare(strip + k, stride);
    if (all[k].cost < all[best].cost) best = k;
  }
  if (best == 0 || best == count - 1 || all[best].cost > kMaxCost) return {};
  return refined(best, all[best - 1], all[best], all[best + 1]);
}

}  // namespace rotrocc
