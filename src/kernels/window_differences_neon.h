#pragma once

#include <arm_neon.h>

#include "kernels/sad_kernels.h"

/// See window_differences.h. NEON.
namespace rotrocc::ROTROCC_INSTRUCTIONS {

class WindowDifferences {
 public:
  explicit WindowDifferences(const SadSearch& search) : search_(search) {
    for (int i = 0; i < kWindow; ++i) rows_[i] = loadRow(search.left + i * search.left_step);
  }

  /// Pixel by pixel of the window, for a group of windows at a time.
  void ofParts(std::int16_t* costs) const {
    static_assert(SadSearch::kGroup == 16);
    for (int k = 0; k < search_.count; k += SadSearch::kGroup) {
      uint16x8_t low = vdupq_n_u16(0);
      uint16x8_t high = vdupq_n_u16(0);
      for (const int row : kPartRows) {
        const std::uint8_t* left = search_.left + row * search_.left_step + kPartEdge;
        const std::uint8_t* right = search_.right + k + row * search_.right_step + kPartEdge;
        for (int x = 0; x < kPartWidth; ++x) {
          const uint8x16_t pixel = vld1q_dup_u8(left + x);
          const uint8x16_t pixels = vld1q_u8(right + x);
          low = vabal_u8(low, vget_low_u8(pixels), vget_low_u8(pixel));
          high = vabal_high_u8(high, pixels, pixel);
        }
      }
      vst1q_s16(costs + k, vreinterpretq_s16_u16(low));
      vst1q_s16(costs + k + 8, vreinterpretq_s16_u16(high));
    }
  }

  /// Row by row of a single window.
  int ofWhole(int k, int limit) const {
    const std::uint8_t* pixels = search_.right + k;
    uint16x8_t sums = vdupq_n_u16(0);
    for (int i = 0; i < kWindow; ++i, pixels += search_.right_step) {
      sums = vpadalq_u8(sums, vabdq_u8(rows_[i], loadRow(pixels)));
      if (i == kWindow / 2 && vaddvq_u16(sums) > limit) return SadSearch::kHigh;
    }
    return vaddvq_u16(sums);
  }

 private:
  static constexpr int kWindow = SadSearch::kWindow;

  static uint8x16_t loadRow(const std::uint8_t* pixels) {
    static constexpr std::uint8_t kMask[16] = {
        255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255};
    return vandq_u8(vld1q_u8(pixels), vld1q_u8(kMask));
  }

  const SadSearch& search_;
  uint8x16_t rows_[kWindow];
};

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
