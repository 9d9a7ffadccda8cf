#include "rotrocc/stereo_matcher.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include <opencv2/core/hal/intrin.hpp>

namespace rotrocc {
namespace {

/// The window is 11 pixels wide and high.
constexpr int kWindow = 11;
constexpr int kHalf = kWindow / 2;
constexpr int kPixels = kWindow * kWindow;

/// A register of bytes holds one row of it, the rest masked out.
constexpr int kRegister = 16;

/// The slopes of a minimum, so far to both sides [px], are no rivals of it.
constexpr int kSlope = 2;

/// Stands for the cost of a column that is higher than any of interest.
constexpr int kHigh = std::numeric_limits<int>::max();

/// Columns are dropped whose part of the window costs half as much again as where that is cheapest,
/// and two grey levels a pixel more. For 4 corners in 1000 of KITTI that changes the answer.
constexpr int kPartNoise = 64;

constexpr float kNoColumn = -1.0F;

/// Columns of a search that a buffer has room for from the beginning.
constexpr std::size_t kUsualColumns = 256;

/// More parts than threads even out what they cost.
constexpr int kParts = 8;

using Bytes = cv::v_uint8x16;
using Words = cv::v_int16x8;
constexpr int kWords = 8;

/// Sums of absolute differences between the window around a left pixel and windows of the same row
/// of the right image, all at whole pixels.
class WholePixelCosts {
 public:
  WholePixelCosts(const cv::Mat& left, const cv::Mat& right, const cv::Point& pixel)
      : right_(right.ptr<uchar>(pixel.y - kHalf) - kHalf), step_(right.step) {
    const uchar* pixels = left.ptr<uchar>(pixel.y - kHalf) + pixel.x - kHalf;
    for (int i = 0; i < kWindow; ++i)
      rows_[i] = loadRow(pixels + static_cast<std::size_t>(i) * left.step);
    pixels += kEdge;
    for (int k = 0; k < kPairs; ++k)
      pairs_[k] =
          loadPair(pixels + kPairRows[k][0] * left.step, pixels + kPairRows[k][1] * left.step);
  }

  /// The sum over a part of the window, all but the edge of every other row but one.
  int part(int column) const {
    const uchar* pixels = right_ + column + kEdge;
    unsigned sum = 0;
    for (int k = 0; k < kPairs; ++k) {
      sum += cv::v_reduce_sad(
          pairs_[k], loadPair(pixels + kPairRows[k][0] * step_, pixels + kPairRows[k][1] * step_));
    }
    return static_cast<int>(sum);
  }
  /// The sum over the whole window; kHigh where it is seen to be more than `limit`.
  int whole(int column, int limit = kHigh) const {
    const uchar* pixels = right_ + column;
    unsigned sum = 0;
    for (int i = 0; i < kWindow; ++i, pixels += step_) {
      sum += cv::v_reduce_sad(rows_[i], loadRow(pixels));
      if (i == kHalf && sum > static_cast<unsigned>(limit)) return kHigh;
    }
    return static_cast<int>(sum);
  }

 private:
  static constexpr int kPairs = 2;
  static constexpr int kEdge = 1;
  static constexpr std::size_t kPairRows[kPairs][2] = {{1, 3}, {7, 9}};

  static Bytes loadRow(const uchar* pixels) {
    alignas(kRegister) static constexpr uchar kMask[kRegister] = {
        255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255};
    return cv::v_load(pixels) & cv::v_load_aligned(kMask);
  }
  static Bytes loadPair(const uchar* upper, const uchar* lower) {
    return cv::v_load_halves(upper, lower);
  }

  const uchar* right_;
  std::size_t step_;
  Bytes rows_[kWindow];
  Bytes pairs_[kPairs];
};

/// The same around a left pixel that may lie between pixels, with the row of the right image that
/// is as high, in eighths of a grey level.
class SubPixelCosts {
 public:
  static constexpr int kUnit = 8;
  static constexpr int kColumns = 2 * StereoMatcher::kNearRadius_px + 3;

  /// `first` of the right columns, and up to kColumns of them, will be asked for.
  SubPixelCosts(const cv::Mat& left, const cv::Mat& right, const cv::Point2f& pixel, int first) {
    const int x = cvFloor(pixel.x);
    const int y = cvFloor(pixel.y);
    const Words fx = fraction(pixel.x - static_cast<float>(x));
    const Words fy = fraction(pixel.y - static_cast<float>(y));
    const uchar* from = left.ptr<uchar>(y - kHalf) + x - kHalf;
    const uchar* right_from = right.ptr<uchar>(y - kHalf) + first - kHalf;
    for (int i = 0; i < kWindow; ++i, from += left.step, right_from += right.step) {
      for (int k = 0; k < kRegister; k += kWords) {
        const Words here = betweenRows(from + k, left.step, fy);
        const Words next = betweenRows(from + k + 1, left.step, fy);
        cv::v_store_aligned(window_[i] + k, between(here, next, fx));
      }
      for (int k = 0; k < kStrip; k += kWords) {
        cv::v_store_aligned(strip_[i] + k, betweenRows(right_from + k, right.step, fy));
      }
    }
  }

  /// Of the k-th column from the first.
  int operator()(int k) const {
    alignas(kRegister) static constexpr ushort kMask[kWords] = {65535, 65535, 65535};
    // Eleven rows of two differences of up to 2040 fit into 16 bits.
    cv::v_uint16x8 sum = cv::v_setzero_u16();
    cv::v_uint16x8 partly = cv::v_setzero_u16();
    for (int i = 0; i < kWindow; ++i) {
      sum = sum + cv::v_absdiff(cv::v_load_aligned(window_[i]), cv::v_load(strip_[i] + k));
      partly = partly + cv::v_absdiff(cv::v_load_aligned(window_[i] + kWords),
                                      cv::v_load(strip_[i] + k + kWords));
    }
    cv::v_uint32x4 low, high;
    cv::v_expand(sum + (partly & cv::v_load_aligned(kMask)), low, high);
    return static_cast<int>(cv::v_reduce_sum(low + high));
  }

 private:
  static constexpr int kUnitBits = 3;
  static constexpr int kStrip = 24;  // kWindow + kColumns - 1, in whole registers
  static_assert(kUnit == 1 << kUnitBits && kStrip >= kWindow + kColumns - 1);

  /// 1 is 2^15.
  static Words fraction(float distance) {
    return cv::v_setall_s16(static_cast<short>(32768.0F * distance));
  }
  static Words between(const Words& a, const Words& b, const Words& fraction) {
    return a + cv::v_mul_hi(cv::v_shl<1>(b - a), fraction);
  }
  static Words betweenRows(const uchar* pixels, std::size_t step, const Words& fraction) {
    const Words upper = cv::v_reinterpret_as_s16(cv::v_load_expand(pixels));
    const Words lower = cv::v_reinterpret_as_s16(cv::v_load_expand(pixels + step));
    return between(cv::v_shl<kUnitBits>(upper), cv::v_shl<kUnitBits>(lower), fraction);
  }

  alignas(kRegister) short window_[kWindow][kRegister];
  alignas(kRegister) short strip_[kWindow][kStrip + kRegister] = {};  // lanes that the mask drops
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

/// Column of the best match, or kNoColumn where it lies at the end of the range, costs more than
/// `most` or is ambiguous: at least `uniqueness` times the cost of a rival.
float bestColumn(const WholePixelCosts& sad,
                 const cv::Range& columns,
                 double most,
                 double uniqueness) {
  thread_local std::vector<int> buffer;
  std::vector<int>& costs = buffer;  // looked up once
  costs.clear();
  costs.reserve(kUsualColumns);
  for (int x = columns.start; x < columns.end; ++x) costs.push_back(sad.part(x));
  const auto likely = std::min_element(costs.begin(), costs.end());
  const int likely_column = columns.start + static_cast<int>(likely - costs.begin());
  const int part_limit = *likely + *likely / 2 + kPartNoise;
  // What costs more can neither be the best nor a rival of it.
  const auto limitOf = [&](double best) { return cvCeil(std::min(best, most) / uniqueness); };
  int limit = limitOf(sad.whole(likely_column));
  int best = -1;
  int least = kHigh;
  for (int k = 0; k < columns.size(); ++k) {
    int& cost = costs[static_cast<std::size_t>(k)];
    cost = cost <= part_limit ? sad.whole(columns.start + k, limit) : kHigh;
    if (cost >= least) continue;
    best = k;
    least = cost;
    limit = std::min(limit, limitOf(least));
  }

  if (best <= 0 || best == columns.size() - 1 || least > most) return kNoColumn;
  for (int k = 0; k < columns.size(); ++k) {
    const bool rival = least >= uniqueness * costs[static_cast<std::size_t>(k)];
    if (rival && std::abs(k - best) > kSlope) return kNoColumn;
  }
  const auto exact = [&](int k) {
    const int cost = costs[static_cast<std::size_t>(k)];
    return cost != kHigh ? cost : sad.whole(columns.start + k);
  };
  return static_cast<float>(columns.start + best) +
         subPixelOffset(exact(best - 1), least, exact(best + 1));
}

/// The same for a few columns, where rivals do not matter.
float bestColumn(const SubPixelCosts& sad, const cv::Range& columns, double most) {
  int costs[SubPixelCosts::kColumns];
  for (int k = 0; k < columns.size(); ++k) costs[k] = sad(k);
  const int* best = std::min_element(costs, costs + columns.size());
  if (best == costs || best == costs + columns.size() - 1) return kNoColumn;
  if (*best > most * SubPixelCosts::kUnit) return kNoColumn;
  return static_cast<float>(columns.start + static_cast<int>(best - costs)) +
         subPixelOffset(best[-1], best[0], best[1]);
}

/// Calls columnOf(i) for each pixel and makes a disparity of the column that it returns.
template <class ColumnOf>
void eachPixel(Workers& workers,
               const std::vector<cv::Point2f>& pixels,
               double least_px,
               std::vector<float>& disparities_px,
               const ColumnOf& columnOf) {
  disparities_px.assign(pixels.size(), StereoMatcher::kNoDisparity);
  workers.run(kParts, [&](int part) {
    const auto p = static_cast<std::size_t>(part);
    const std::size_t end = pixels.size() * (p + 1) / kParts;
    for (std::size_t i = pixels.size() * p / kParts; i < end; ++i) {
      const float column = columnOf(i);
      const float disparity_px = pixels[i].x - column;
      if (column != kNoColumn && disparity_px >= least_px) disparities_px[i] = disparity_px;
    }
  });
}

}  // namespace

void StereoMatcher::match(Workers& workers,
                          const cv::Mat& left,
                          const cv::Mat& right,
                          const std::vector<cv::Point2f>& corners,
                          double infinity_px,
                          std::vector<float>& disparities_px) const {
  const int nearest = config_.max_disparity_px + cvCeil(infinity_px);
  const int farthest = cvFloor(config_.min_disparity_px + infinity_px);
  const double most = config_.max_mean_difference * kPixels;
  const double least_px = config_.min_disparity_px + infinity_px;
  eachPixel(workers, corners, least_px, disparities_px, [&](std::size_t i) {
    if (!windowInside(left, corners[i])) return kNoColumn;
    const cv::Point pixel(cvRound(corners[i].x), cvRound(corners[i].y));
    const cv::Range columns = clip(right, cv::Range(pixel.x - nearest - 1, pixel.x - farthest + 2));
    if (columns.size() < 3) return kNoColumn;
    return bestColumn(WholePixelCosts(left, right, pixel), columns, most, config_.uniqueness);
  });
}

void StereoMatcher::matchNear(Workers& workers,
                              const cv::Mat& left,
                              const cv::Mat& right,
                              const std::vector<cv::Point2f>& pixels,
                              const std::vector<float>& expected_px,
                              double infinity_px,
                              std::vector<float>& disparities_px) const {
  const double most = config_.max_mean_difference * kPixels;
  const double least_px = config_.min_disparity_px + infinity_px;
  eachPixel(workers, pixels, least_px, disparities_px, [&](std::size_t i) {
    if (expected_px[i] == kNoDisparity || !windowInside(left, pixels[i])) return kNoColumn;
    const int x = cvRound(pixels[i].x - expected_px[i]);
    const cv::Range columns =
        clip(right, cv::Range(x - kNearRadius_px - 1, x + kNearRadius_px + 2));
    if (columns.size() < 3) return kNoColumn;
    return bestColumn(SubPixelCosts(left, right, pixels[i], columns.start), columns, most);
  });
}

}  // namespace rotrocc
