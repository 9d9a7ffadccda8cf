#pragma once

#include <opencv2/core.hpp>
#include <opencv2/core/hal/intrin.hpp>

#include "kernels/sad_kernels.h"

/// See window_differences.h. OpenCV's universal intrinsics.
namespace rotrocc::ROTROCC_INSTRUCTIONS {

class WindowDifferences {
 public:
  explicit WindowDifferences(const SadSearch& search) : search_(search) {
    for (int i = 0; i < kWindow; ++i) rows_[i] = loadRow(search.left + i * search.left_step);
    for (int i = 0; i < 2; ++i) pairs_[i] = loadPair(search.left, search.left_step, 2 * i);
  }

  /// Fills `costs` with the sums over the part that is compared first.
  void ofParts(std::int16_t* costs) const {
    for (int k = 0; k < search_.count; ++k) {
      unsigned sum = 0;
      for (int i = 0; i < 2; ++i) {
        sum += cv::v_reduce_sad(pairs_[i], loadPair(search_.right + k, search_.right_step, 2 * i));
      }
      costs[k] = static_cast<std::int16_t>(sum);
    }
  }

  /// Returns kHigh if the sum over the first half of the rows already exceeds `limit`.
  int ofWhole(int k, int limit) const {
    const std::uint8_t* pixels = search_.right + k;
    unsigned sum = 0;
    for (int i = 0; i < kWindow; ++i, pixels += search_.right_step) {
      sum += cv::v_reduce_sad(rows_[i], loadRow(pixels));
      if (i == kWindow / 2 && sum > static_cast<unsigned>(limit)) return SadSearch::kHigh;
    }
    return static_cast<int>(sum);
  }

 private:
  /// A row of a window, with the pixels beyond it masked out.
  using Bytes = cv::v_uint8x16;
  static constexpr int kWindow = SadSearch::kWindow;

  static Bytes loadRow(const std::uint8_t* pixels) {
    alignas(16) static constexpr std::uint8_t kMask[16] = {
        255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255};
    return cv::v_load(pixels) & cv::v_load_aligned(kMask);
  }

  /// Loads rows k and k + 1 of the part that is compared first.
  static Bytes loadPair(const std::uint8_t* pixels, std::ptrdiff_t step, int k) {
    static_assert(kPartWidth == 8);
    return cv::v_load_halves(pixels + kPartRows[k] * step + kPartEdge,
                             pixels + kPartRows[k + 1] * step + kPartEdge);
  }

  const SadSearch& search_;
  Bytes rows_[kWindow];
  Bytes pairs_[2];
};

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
