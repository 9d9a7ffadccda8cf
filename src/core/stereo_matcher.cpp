#include "rotrocc/stereo_matcher.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include <opencv2/core/hal/intrin.hpp>

namespace rotrocc {
namespace {

/// The window is 11 pixels wide and high; a SIMD register holds one row of it, the rest masked out.
constexpr int kWindow = 11;
constexpr int kHalf = kWindow / 2;
constexpr int kRegister = 16;
constexpr int kPixels = kWindow * kWindow;

/// More parts than threads even out what they cost.
constexpr int kParts = 8;

#if CV_SIMD128
using Row = cv::v_uint8x16;

Row loadRow(const uchar* pixels) {
  alignas(16) static const std::array<uchar, kRegister> mask = {
      255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 0, 0};
  return cv::v_load(pixels) & cv::v_load_aligned(mask.data());
}

int difference(const Row& a, const Row& b) {
  return static_cast<int>(cv::v_reduce_sad(a, b));
}
#else
using Row = std::array<uchar, kWindow>;

Row loadRow(const uchar* pixels) {
  Row row;
  std::copy(pixels, pixels + kWindow, row.begin());
  return row;
}

int difference(const Row& a, const Row& b) {
  int sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += std::abs(static_cast<int>(a[i]) - static_cast<int>(b[i]));
  return sum;
}
#endif

/// Sums of absolute differences between the window around a left pixel and windows of the same row
/// of the right image. Pixels between the rows or columns are interpolated.
class RowSearch {
 public:
  /// `columns` of the right image are those that will be asked for.
  RowSearch(const cv::Mat& left,
            const cv::Mat& right,
            const cv::Point2f& pixel,
            const cv::Range& columns)
      : first_(columns.start) {
    const int x = cvFloor(pixel.x);
    const int y = cvFloor(pixel.y);
    const float dx = pixel.x - static_cast<float>(x);
    const float dy = pixel.y - static_cast<float>(y);
    alignas(kRegister) uchar buffer[kRegister] = {};
    for (int i = 0; i < kWindow; ++i) {
      const uchar* row = left.ptr<uchar>(y - kHalf + i) + x - kHalf;
      if (dx != 0.0F || dy != 0.0F) {
        interpolate(row, left.step, dx, dy, kWindow, buffer);
        row = buffer;
      }
      window_[index(i)] = loadRow(row);
      rows_[index(i)] = right.ptr<uchar>(y - kHalf + i) + first_ - kHalf;
    }
    if (dy != 0.0F) interpolateRight(right.step, dy, columns.size() + kRegister);
  }

  int operator()(int column) const {
    int sum = 0;
    for (int i = 0; i < kWindow; ++i) {
      sum += difference(window_[index(i)], loadRow(rows_[index(i)] + column - first_));
    }
    return sum;
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  static void interpolate(
      const uchar* row, std::size_t step, float dx, float dy, int count, uchar* out) {
    const uchar* below = dy != 0.0F ? row + step : row;
    const int right = dx != 0.0F ? 1 : 0;
    for (int i = 0; i < count; ++i) {
      const float top = (1.0F - dx) * row[i] + dx * row[i + right];
      const float bottom = (1.0F - dx) * below[i] + dx * below[i + right];
      out[i] = static_cast<uchar>((1.0F - dy) * top + dy * bottom + 0.5F);
    }
  }

  void interpolateRight(std::size_t step, float dy, int count) {
    strip_.resize(index(kWindow * count));
    for (int i = 0; i < kWindow; ++i) {
      uchar* out = strip_.data() + i * count;
      interpolate(rows_[index(i)], step, 0.0F, dy, count, out);
      rows_[index(i)] = out;
    }
  }

  int first_;
  std::array<Row, kWindow> window_;
  std::array<const uchar*, kWindow> rows_;
  std::vector<uchar> strip_;
};

/// Whether the window around a left pixel can be read, the pixels right of it and below included.
bool windowInside(const cv::Mat& image, const cv::Point2f& p) {
  return p.x >= kHalf && p.y >= kHalf && p.x < static_cast<float>(image.cols - kRegister) &&
         p.y < static_cast<float>(image.rows - kHalf - 1);
}

/// The part of a range of right columns whose windows can be read.
cv::Range clip(const cv::Mat& image, const cv::Range& columns) {
  return {std::max(columns.start, kHalf), std::min(columns.end, image.cols - kRegister)};
}

/// Offset of the minimum of the costs at -1, 0 and 1. SAD falls and rises linearly, so two lines of
/// equal slope fit it better than a parabola.
float subPixelOffset(int before, int at, int after) {
  const int slope = std::max(before, after) - at;
  if (slope <= 0) return 0.0F;
  return 0.5F * static_cast<float>(before - after) / static_cast<float>(slope);
}

/// Whether a cost away from the minimum comes near to it. The slopes of the minimum are no rivals.
bool hasRival(const std::vector<int>& costs,
              std::vector<int>::const_iterator best,
              double uniqueness) {
  constexpr std::ptrdiff_t kSlope = 2;
  for (auto it = costs.begin(); it != costs.end(); ++it) {
    if (std::abs(it - best) > kSlope && *best >= uniqueness * *it) return true;
  }
  return false;
}

/// Column of the best match, or a negative number where it lies at the end of the range, differs
/// too much or is ambiguous. `uniqueness` of 0 accepts rivals.
float bestColumn(const RowSearch& sad,
                 const cv::Range& columns,
                 double max_mean_difference,
                 double uniqueness) {
  constexpr float kNone = -1.0F;
  thread_local std::vector<int> costs;
  costs.clear();
  for (int x = columns.start; x < columns.end; ++x) costs.push_back(sad(x));

  const auto best = std::min_element(costs.begin(), costs.end());
  if (best == costs.begin() || best == costs.end() - 1) return kNone;
  if (*best > max_mean_difference * kPixels) return kNone;
  if (uniqueness > 0.0 && hasRival(costs, best, uniqueness)) return kNone;
  return static_cast<float>(columns.start + (best - costs.begin())) +
         subPixelOffset(*(best - 1), *best, *(best + 1));
}

}  // namespace

void StereoMatcher::match(Workers& workers,
                          const cv::Mat& left,
                          const cv::Mat& right,
                          const std::vector<cv::Point2f>& pixels,
                          double infinity_px,
                          std::vector<float>& disparities_px) const {
  const int nearest = config_.max_disparity_px + cvCeil(infinity_px);
  const int farthest = cvFloor(config_.min_disparity_px + infinity_px);
  const auto columns = [&](std::size_t i) {
    const int x = cvFloor(pixels[i].x);
    return cv::Range(x - nearest - 1, x - farthest + 2);
  };
  search(workers, left, right, pixels, columns, config_.uniqueness, infinity_px, disparities_px);
}

void StereoMatcher::matchNear(Workers& workers,
                              const cv::Mat& left,
                              const cv::Mat& right,
                              const std::vector<cv::Point2f>& pixels,
                              const std::vector<float>& expected_px,
                              int radius_px,
                              double infinity_px,
                              std::vector<float>& disparities_px) const {
  const auto columns = [&](std::size_t i) {
    if (expected_px[i] == kNoDisparity) return cv::Range();
    const int x = cvRound(pixels[i].x - expected_px[i]);
    return cv::Range(x - radius_px - 1, x + radius_px + 2);
  };
  search(workers, left, right, pixels, columns, 0.0, infinity_px, disparities_px);
}

void StereoMatcher::search(Workers& workers,
                           const cv::Mat& left,
                           const cv::Mat& right,
                           const std::vector<cv::Point2f>& pixels,
                           const std::function<cv::Range(std::size_t)>& columns_of,
                           double uniqueness,
                           double infinity_px,
                           std::vector<float>& disparities_px) const {
  const double least_px = config_.min_disparity_px + infinity_px;
  disparities_px.assign(pixels.size(), kNoDisparity);
  workers.run(kParts, [&](int part) {
    const auto p = static_cast<std::size_t>(part);
    const std::size_t end = pixels.size() * (p + 1) / kParts;
    for (std::size_t i = pixels.size() * p / kParts; i < end; ++i) {
      if (!windowInside(left, pixels[i])) continue;
      const cv::Range columns = clip(right, columns_of(i));
      if (columns.size() < 3) continue;
      const RowSearch sad(left, right, pixels[i], columns);
      const float column = bestColumn(sad, columns, config_.max_mean_difference, uniqueness);
      const float disparity_px = pixels[i].x - column;
      if (column >= 0.0F && disparity_px >= least_px) disparities_px[i] = disparity_px;
    }
  });
}

}  // namespace rotrocc
