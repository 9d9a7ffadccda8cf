#pragma once

#include <algorithm>
#include <numeric>

#include <opencv2/core.hpp>
#include <opencv2/core/hal/intrin.hpp>

#include "features/stereo_matcher.h"
#include "kernels/sad_kernels.h"

/// Matching costs of windows of the left and the right image.
namespace rotrocc::sad {

/// Width and height of the window.
constexpr int kWindow = SadSearch::kWindow;
constexpr int kHalf = kWindow / 2;
constexpr int kPixels = kWindow * kWindow;

/// Number of pixels read from each row.
constexpr int kRegister = SadSearch::kReadPixels;

using Words = cv::v_int16x8;
constexpr int kWords = 8;

/// Sums of absolute differences between the window around a left pixel, at sub-pixel position, and
/// windows of the right image in one row, in eighths of a grey level. The mean of each
/// window is subtracted, and the lighter image gets the contrast of the darker, because cameras
/// differ in exposure; the tracker does the same.
class SubPixelCosts {
 public:
  static constexpr int kUnit = 8;
  static constexpr int kColumns = 2 * StereoMatcher::kNearRadius_px + 3;

  /// Prepares up to kColumns right columns, starting at `first`, in row `right_row`. `gain` is that
  /// from the left to the right image.
  SubPixelCosts(const cv::Mat& left,
                const cv::Mat& right,
                const cv::Point2f& pixel,
                float right_row,
                double gain,
                int first) {
    const int x = cvFloor(pixel.x);
    const int y = cvFloor(pixel.y);
    const Words fx = fraction(pixel.x - static_cast<float>(x));
    const Words fy = fraction(pixel.y - static_cast<float>(y));
    const int right_y = cvFloor(right_row);
    const Words right_fy = fraction(right_row - static_cast<float>(right_y));
    const Words left_darker = fraction(static_cast<float>(std::max(0.0, 1.0 - gain)));
    const Words right_darker = fraction(static_cast<float>(std::max(0.0, 1.0 - 1.0 / gain)));
    const uchar* from = left.ptr<uchar>(y - kHalf) + x - kHalf;
    const uchar* right_from = right.ptr<uchar>(right_y - kHalf) + first - kHalf;
    // Eleven values of up to 2040 fit into 16 bits.
    alignas(kRegister) short window_sums[kRegister] = {};
    alignas(kRegister) short strip_sums[kStrip] = {};
    for (int i = 0; i < kWindow; ++i, from += left.step, right_from += right.step) {
      for (int k = 0; k < kRegister; k += kWords) {
        const Words here = betweenRows(from + k, left.step, fy);
        const Words next = betweenRows(from + k + 1, left.step, fy);
        const Words values = darkened(between(here, next, fx), left_darker);
        cv::v_store_aligned(window_[i] + k, values);
        cv::v_store_aligned(window_sums + k, cv::v_load_aligned(window_sums + k) + values);
      }
      for (int k = 0; k < kStrip; k += kWords) {
        const Words values =
            darkened(betweenRows(right_from + k, right.step, right_fy), right_darker);
        cv::v_store_aligned(strip_[i] + k, values);
        cv::v_store_aligned(strip_sums + k, cv::v_load_aligned(strip_sums + k) + values);
      }
    }
    const int of_window = std::accumulate(window_sums, window_sums + kWindow, 0);
    for (int k = 0; k < kColumns; ++k) {
      const int of_column = std::accumulate(strip_sums + k, strip_sums + k + kWindow, 0);
      brighter_[k] = static_cast<short>((of_window - of_column) / kPixels);
    }
  }

  /// The cost of the k-th column from `first`.
  int operator()(int k) const {
    alignas(kRegister) static constexpr ushort kMask[kWords] = {65535, 65535, 65535};
    // Eleven rows of two differences of up to 2040 fit into 16 bits; larger sums saturate.
    const Words brighter = cv::v_setall_s16(brighter_[k]);
    cv::v_uint16x8 sum = cv::v_setzero_u16();
    cv::v_uint16x8 partly = cv::v_setzero_u16();
    for (int i = 0; i < kWindow; ++i) {
      sum =
          sum + cv::v_absdiff(cv::v_load_aligned(window_[i]), cv::v_load(strip_[i] + k) + brighter);
      partly = partly + cv::v_absdiff(cv::v_load_aligned(window_[i] + kWords),
                                      cv::v_load(strip_[i] + k + kWords) + brighter);
    }
    cv::v_uint32x4 low, high;
    cv::v_expand(sum + (partly & cv::v_load_aligned(kMask)), low, high);
    return static_cast<int>(cv::v_reduce_sum(low + high));
  }

 private:
  static constexpr int kUnitBits = 3;
  static constexpr int kStrip = 24;  // kWindow + kColumns - 1, rounded up to whole registers
  static_assert(kUnit == 1 << kUnitBits && kStrip >= kWindow + kColumns - 1);

  /// Fixed-point fraction: 1 is 2^15.
  static Words fraction(float distance) {
    return cv::v_setall_s16(static_cast<short>(32768.0F * distance));
  }
  static Words between(const Words& a, const Words& b, const Words& fraction) {
    const Words difference = b - a;
    return a + cv::v_mul_hi(difference + difference, fraction);
  }
  static Words darkened(const Words& a, const Words& fraction) {
    return a - cv::v_mul_hi(a + a, fraction);
  }
  static Words betweenRows(const uchar* pixels, std::size_t step, const Words& fraction) {
    const Words upper = cv::v_reinterpret_as_s16(cv::v_load_expand(pixels));
    const Words lower = cv::v_reinterpret_as_s16(cv::v_load_expand(pixels + step));
    return between(cv::v_shl<kUnitBits>(upper), cv::v_shl<kUnitBits>(lower), fraction);
  }

  short brighter_[kColumns];  // left window minus right window, mean grey level
  alignas(kRegister) short window_[kWindow][kRegister];
  alignas(kRegister) short strip_[kWindow][kStrip + kRegister] = {};  // the padding is masked out
};

}  // namespace rotrocc::sad
