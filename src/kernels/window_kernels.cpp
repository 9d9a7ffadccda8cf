#include "kernels/window_kernels.h"

#include "kernels/lanes.h"

namespace rotrocc::ROTROCC_INSTRUCTIONS {
namespace {

// Sums over all rows of a window fit into 32 bits, two products per lane: the largest are squares
// of differences of 255 gray levels.
static_assert(2LL * Window::kMaxSide * (255LL << MismatchSums::kDifferenceBits) *
                  (255LL << MismatchSums::kDifferenceBits) <=
              2147483647LL);

constexpr int kStride = Window::kStride;

/// Scharr gradient, weighted by (3 10 3) / 16, from the differences of three rows or columns of
/// pixels that are two apart.
Shorts scharr(const Shorts& before, const Shorts& here, const Shorts& after) {
  const Shorts middle = v_mul_hi(shiftLeft<1>(here), vx_setall_s16(20480));  // 10 / 32
  const Shorts sides = v_mul_hi(before + after, vx_setall_s16(12288));       // 3 / 16
  // One unit compensates the truncation of both products; the rest rounds.
  constexpr int kShift = Window::kValueBits + 1 - Window::kGradientBits;
  constexpr std::int16_t kRounding = 1 + (1 << (kShift - 1));
  return v_shr<kShift>(middle + sides + vx_setall_s16(kRounding));
}

Shorts difference(const std::int16_t* a, const std::int16_t* b) {
  return vx_load(a) - vx_load(b);
}

}  // namespace

WindowSums takeWindow(const Patch& patch, Window& window) {
  // As wide as a window, and a register to read on.
  constexpr int kSampleStride = Window::kStride + kShorts;
  std::int16_t samples[(Window::kMaxSide + 2) * kSampleStride];
  samplePatch<Window::kValueBits>(patch, window.side + 2, window.side + 2, samples, kSampleStride);
  constexpr int kToContrast = Window::kValueBits - Window::kContrastBits;
  const int middle = window.side / 2 + 1;
  const Shorts middle_value = vx_setall_s16(samples[middle * kSampleStride + middle]);
  WindowSums sums = {};
  for (int x = 0; x < window.side; x += kShorts) {
    const Shorts mask = vx_load(window.mask + x);
    Ints minus_x = vx_setzero_s32();
    Ints minus_y = vx_setzero_s32();
    Ints minus_contrast = vx_setzero_s32();
    Ints xx = vx_setzero_s32();
    Ints xy = vx_setzero_s32();
    Ints yy = vx_setzero_s32();
    Ints contrast_x = vx_setzero_s32();
    Ints contrast_y = vx_setzero_s32();
    Ints contrast_square = vx_setzero_s32();
    const std::int16_t* above = samples + x;
    for (int at = x; at < window.side * kStride; at += kStride) {
      const std::int16_t* here = above + kSampleStride;
      const std::int16_t* below = here + kSampleStride;
      const Shorts gx = scharr(difference(above + 2, above),
                               difference(here + 2, here),
                               difference(below + 2, below)) &
                        mask;
      const Shorts gy = scharr(difference(below, above),
                               difference(below + 1, above + 1),
                               difference(below + 2, above + 2)) &
                        mask;
      const Shorts value = vx_load(here + 1);
      const Shorts contrast = v_shr<kToContrast>(value - middle_value) & mask;
      v_store(window.values + at, value);
      v_store(window.gradient_x + at, gx);
      v_store(window.gradient_y + at, gy);
      v_store(window.contrast + at, contrast);
      minus_x += v_dotprod(gx, mask);
      minus_y += v_dotprod(gy, mask);
      minus_contrast += v_dotprod(contrast, mask);
      xx += v_dotprod(gx, gx);
      xy += v_dotprod(gx, gy);
      yy += v_dotprod(gy, gy);
      contrast_x += v_dotprod(contrast, gx);
      contrast_y += v_dotprod(contrast, gy);
      contrast_square += v_dotprod(contrast, contrast);
      above = here;
    }
    sums.x -= sum(minus_x);
    sums.y -= sum(minus_y);
    sums.contrast -= sum(minus_contrast);
    sums.xx += sum(xx);
    sums.xy += sum(xy);
    sums.yy += sum(yy);
    sums.contrast_x += sum(contrast_x);
    sums.contrast_y += sum(contrast_y);
    sums.contrast_square += sum(contrast_square);
  }
  return sums;
}

MismatchSums compareWindow(const Patch& patch, const Window& window) {
  const Shorts fx = vx_setall_s16(patch.fx);
  const Shorts fy = vx_setall_s16(patch.fy);
  constexpr int kShift = Window::kValueBits - MismatchSums::kDifferenceBits;
  MismatchSums sums = {};
  for (int x = 0; x < window.side; x += kShorts) {
    const std::uint8_t* pixels = patch.pixels + x;
    const Shorts mask = vx_load(window.mask + x);
    Ints minus_sum = vx_setzero_s32();
    Ints sum_x = vx_setzero_s32();
    Ints sum_y = vx_setzero_s32();
    Ints contrast = vx_setzero_s32();
    Ints square = vx_setzero_s32();
    Shorts upper = betweenColumns<Window::kValueBits>(pixels, fx);
    for (int at = x; at < window.side * kStride; at += kStride) {
      pixels += patch.step;
      const Shorts lower = betweenColumns<Window::kValueBits>(pixels, fx);
      const Shorts excess =
          v_shr<kShift>(betweenRows(upper, lower, fy) - vx_load(window.values + at)) & mask;
      minus_sum += v_dotprod(excess, mask);
      sum_x += v_dotprod(excess, vx_load(window.gradient_x + at));
      sum_y += v_dotprod(excess, vx_load(window.gradient_y + at));
      contrast += v_dotprod(excess, vx_load(window.contrast + at));
      square += v_dotprod(excess, excess);
      upper = lower;
    }
    sums.one -= sum(minus_sum);
    sums.x += sum(sum_x);
    sums.y += sum(sum_y);
    sums.contrast += sum(contrast);
    sums.square += sum(square);
  }
  return sums;
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
