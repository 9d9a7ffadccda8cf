#pragma once

#include <limits>

#include <opencv2/core.hpp>
#include <opencv2/core/hal/intrin.hpp>

#include "rotrocc/stereo_matcher.h"

/// What windows of the left and the right image cost to be taken for the same.
namespace rotrocc::sad {

/// The window is 11 pixels wide and high.
constexpr int kWindow = 11;
constexpr int kHalf = kWindow / 2;
constexpr int kPixels = kWindow * kWindow;

/// A register of bytes holds one row of it, the rest masked out.
constexpr int kRegister = 16;

/// Stands for the cost of a column that is higher than any of interest.
constexpr int kHigh = std::numeric_limits<int>::max();

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

}  // namespace rotrocc::sad
