#include "features/stereo_matcher.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <vector>

#include "features/patch.h"
#include "kernels/kernels.h"

namespace rotrocc {
namespace {

using W = CorrelationWindow;

constexpr int kHalf = W::kSide / 2;
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

/// Variance of rounding to whole gray levels. It limits the correlation of windows without texture.
constexpr double kRounding = 1.0 / 12.0;

/// Offset of the minimum of the parabola through the costs at -1, 0 and 1.
float subPixelOffset(double before, double at, double after) {
  const double curvature = before - 2.0 * at + after;
  if (!(curvature > 0.0)) return 0.0F;
  return static_cast<float>(std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5));
}

/// Makes a buffer that is used again and again large enough.
template <class T>
T* holding(int count, std::vector<T>& buffer) {
  const auto size = static_cast<std::size_t>(count);
  if (buffer.size() < size) buffer.resize(size);
  return buffer.data();
}

/// A match and the contrast of its window relative to that of the left one.
struct RowMatch {
  float column;
  double gain;
};

/// Buffers of a search along a row.
struct RowBuffers {
  std::vector<std::int16_t> strip;
  std::vector<std::int32_t> scratch;
  std::vector<float> correlations;
  std::vector<int> peaks;     // columns
  std::vector<double> costs;  // of the peaks
};

/// The window around a left pixel. Its cost relative to another window is 1 minus their correlation
/// coefficient: zero-mean normalized cross-correlation, which no difference in brightness or
/// contrast changes. That is half the mean squared difference of both, each scaled to variance 1.
class LeftWindow {
 public:
  /// At whole pixels.
  LeftWindow(const Kernels& kernels, const cv::Mat& left, const cv::Point& pixel)
      : kernels_(kernels), unit2_(1.0) {
    kernels.widenRows(left.ptr<uchar>(pixel.y - kHalf) + pixel.x - kHalf,
                      static_cast<std::ptrdiff_t>(left.step),
                      W::kStride,
                      values_,
                      W::kStride);
    describe();
  }

  /// Between pixels.
  LeftWindow(const Kernels& kernels, const cv::Mat& left, const cv::Point2f& pixel)
      : kernels_(kernels), unit2_(1 << 2 * W::kSampleBits) {
    kernels.sampleRows(patchAt(left, pixel, kHalf), W::kStride, values_, W::kStride);
    describe();
  }

  /// Searches a right row for the best of `count` windows, the first of which begins at `pixels`.
  std::optional<RowMatch> searchRow(const uchar* pixels,
                                    std::ptrdiff_t step,
                                    int count,
                                    RowBuffers& buffers) const;

  /// As searchRow(), for a few windows and without a test for competitors.
  std::optional<RowMatch> searchNear(const std::int16_t* strip, int stride, int count) const;

 private:
  struct Compared {
    double cost;
    double variance;
  };

  void describe() {
    const ProductSums own = kernels_.multiplyWindow(values_, values_, W::kStride);
    sum_ = own.b;
    variance_ = varianceOf(own);
  }

  /// Times the square of the number of pixels.
  double varianceOf(const ProductSums& sums) const {
    constexpr double kCount = kPixels;
    const double sum = sums.b;
    return kCount * sums.bb - sum * sum + kCount * kCount * kRounding * unit2_;
  }

  Compared compare(const std::int16_t* strip, int stride) const {
    const ProductSums sums = kernels_.multiplyWindow(values_, strip, stride);
    const double variance = varianceOf(sums);
    const double covariance = static_cast<double>(kPixels) * sums.ab - double{sum_} * sums.b;
    return {1.0 - covariance / std::sqrt(variance_ * variance), variance};
  }

  RowMatch refined(int column,
                   const Compared& before,
                   const Compared& at,
                   const Compared& after) const {
    return {static_cast<float>(column) + subPixelOffset(before.cost, at.cost, after.cost),
            std::sqrt(at.variance / variance_)};
  }

  const Kernels& kernels_;
  double unit2_;
  double sum_ = 0.0;
  double variance_ = 0.0;
  std::int16_t values_[W::kSide * W::kStride];
};

std::optional<RowMatch> LeftWindow::searchRow(const uchar* pixels,
                                              std::ptrdiff_t step,
                                              int count,
                                              RowBuffers& buffers) const {
  const int stride = count + W::kStride + kMaxShorts;
  std::int16_t* const strip = holding(W::kSide * stride + kMaxShorts, buffers.strip);
  kernels_.widenRows(pixels, step, count + W::kSide - 1, strip, stride);
  std::int32_t* const scratch = holding(W::scratchOf(count), buffers.scratch);
  float* const correlations = holding(count + kMaxShorts, buffers.correlations);
  constexpr auto kNoise = static_cast<float>(W::kPartPixels * W::kPartPixels * kRounding);
  const float highest =
      kernels_.correlateParts(values_, strip, stride, count, kNoise, scratch, correlations);
  if (!(highest > 0.0F)) return std::nullopt;
  const float max_cost = partLimit(1.0F - std::sqrt(highest));
  const float min_correlation = max_cost < 1.0F ? (1.0F - max_cost) * (1.0F - max_cost) : 0.0F;
  int* const columns = holding(count, buffers.peaks);
  const int peaks = kernels_.findPeaks(correlations, 0, count - 2, 1, min_correlation, columns);
  double* const costs = holding(peaks, buffers.costs);
  const auto compareAt = [&](int column) { return compare(strip + column, stride); };
  int best = -1;
  Compared of_best = {2.0, 0.0};
  for (int i = 0; i < peaks; ++i) {
    const int column = ++columns[i];  // it was that of the first neighbor
    const Compared compared = compareAt(column);
    costs[i] = compared.cost;
    if (compared.cost >= of_best.cost) continue;
    of_best = compared;
    best = column;
  }
  if (best < 0) return std::nullopt;
  Compared before = compareAt(best - 1);
  Compared after = compareAt(best + 1);
  const int next = after.cost < before.cost ? best + 1 : best - 1;
  if (std::min(before.cost, after.cost) < of_best.cost && next >= 1 && next + 1 < count) {
    best = next;
    before = compareAt(best - 1);
    of_best = compareAt(best);
    after = compareAt(best + 1);
  }
  if (of_best.cost > kMaxCost) return std::nullopt;
  for (int i = 0; i < peaks; ++i) {
    const bool competes = std::abs(columns[i] - best) > kSlope;
    if (competes && of_best.cost >= kUniqueness * costs[i]) return std::nullopt;
  }
  return refined(best, before, of_best, after);
}

std::optional<RowMatch> LeftWindow::searchNear(const std::int16_t* strip,
                                               int stride,
                                               int count) const {
  constexpr int kMaxCount = 2 * StereoMatcher::kNearRadius_px + 3;
  Compared all[kMaxCount];
  int best = 0;
  for (int k = 0; k < count; ++k) {
    all[k] = compare(strip + k, stride);
    if (all[k].cost < all[best].cost) best = k;
  }
  if (best == 0 || best == count - 1 || all[best].cost > kMaxCost) return std::nullopt;
  return refined(best, all[best - 1], all[best], all[best + 1]);
}

/// Whether windows in a row of the image can be read, including the pixels below. Registers read on
/// into one more row.
bool rowInside(const cv::Mat& image, float row) {
  return row >= kHalf && row < static_cast<float>(image.rows - kHalf - 2);
}

/// Whether the window around a left pixel can be read, including the pixels to its right and below.
bool windowInside(const cv::Mat& image, const cv::Point2f& p) {
  return p.x >= kHalf && p.x < static_cast<float>(image.cols - W::kStride) && rowInside(image, p.y);
}

/// The part of a range of right columns whose windows can be read.
cv::Range clip(const cv::Mat& image, const cv::Range& columns) {
  return {std::max(columns.start, kHalf), std::min(columns.end, image.cols - W::kStride)};
}

/// The match of a pixel whose windows begin in column `first`, with a disparity of `min_px` or
/// more.
std::optional<StereoMatch> matchOf(const cv::Point2f& pixel,
                                   const std::optional<RowMatch>& found,
                                   int first,
                                   double min_px) {
  if (!found) return std::nullopt;
  const float disparity_px = pixel.x - (found->column + static_cast<float>(first));
  if (disparity_px < min_px) return std::nullopt;
  return StereoMatch{disparity_px, found->gain};
}

}  // namespace

double StereoMatcher::leastDisparity(const StereoCamera& camera) const {
  return config_.min_disparity_px + camera.disparityAtInfinity();
}

std::optional<StereoMatch> StereoMatcher::match(const RectifiedImages& images,
                                                const cv::Point2f& corner) const {
  const auto& [left, right, camera, row_offset_px] = images;
  const cv::Point pixel(cvRound(corner.x), cvRound(corner.y));
  const int row = pixel.y + cvRound(row_offset_px);
  if (!windowInside(left, corner) || !rowInside(right, static_cast<float>(row))) {
    return std::nullopt;
  }
  const int nearest = cvCeil(camera.fx / config_.nearest_baselines + camera.disparityAtInfinity());
  const double least_px = leastDisparity(camera);
  const int farthest = cvFloor(least_px);
  const cv::Range columns = clip(right, cv::Range(pixel.x - nearest - 1, pixel.x - farthest + 2));
  if (columns.size() < 3) return std::nullopt;
  thread_local RowBuffers buffers;
  const auto found = LeftWindow(chooseKernels(), left, pixel)
                         .searchRow(right.ptr<uchar>(row - kHalf) + columns.start - kHalf,
                                    static_cast<std::ptrdiff_t>(right.step),
                                    columns.size(),
                                    buffers);
  return matchOf(corner, found, columns.start, least_px);
}

std::optional<StereoMatch> StereoMatcher::matchNear(const RectifiedImages& images,
                                                    const cv::Point2f& pixel,
                                                    float expected_px) const {
  const auto& [left, right, camera, row_offset_px] = images;
  const float row = pixel.y + static_cast<float>(row_offset_px);
  if (!windowInside(left, pixel) || !rowInside(right, row)) return std::nullopt;
  const int x = cvRound(pixel.x - expected_px);
  const cv::Range columns = clip(right, cv::Range(x - kNearRadius_px - 1, x + kNearRadius_px + 2));
  if (columns.size() < 3) return std::nullopt;
  const Kernels& kernels = chooseKernels();
  constexpr int kStride = 2 * W::kStride;
  std::int16_t strip[W::kSide * kStride];
  kernels.sampleRows(patchAt(right, {static_cast<float>(columns.start), row}, kHalf),
                     columns.size() + W::kSide - 1,
                     strip,
                     kStride);
  const auto found = LeftWindow(kernels, left, pixel).searchNear(strip, kStride, columns.size());
  return matchOf(pixel, found, columns.start, leastDisparity(camera));
}

}  // namespace rotrocc
