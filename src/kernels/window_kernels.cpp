#include "kernels/window_kernels.h"

#include "kernels/interpolation.h"

namespace rotrocc::ROTROCC_INSTRUCTIONS {
namespace {

/// Number of rows whose products fit into 32 bits, two per lane. With spreading, values are up to
/// 485 grey levels, and differences as many; squares of the latter are the largest products.
constexpr int kBlockRows = 16;

/// Scharr gradient, weighted by (3 10 3) / 16, from the differences of three rows or columns of
/// pixels that are two apart.
Shorts scharr(const Shorts& before, const Shorts& here, const Shorts& after) {
  const Shorts middle = multiplyHigh(shiftLeft<1>(here), all(std::int16_t{20480}));  // 10 / 32
  const Shorts sides = multiplyHigh(before + after, all(std::int16_t{12288}));       // 3 / 16
  // One unit compensates the truncation of both products; the rest rounds.
  constexpr int kShift = Window::kValueBits + 1 - Window::kGradientBits;
  constexpr std::int16_t kRounding = 1 + (1 << (kShift - 1));
  return shiftRight<kShift>(middle + sides + all(kRounding));
}

Shorts difference(const std::int16_t* a, const std::int16_t* b) {
  return load(a) - load(b);
}

void sample(const Patch& patch, const Window window) {
  const Shorts fx = all(patch.fx);
  const Shorts fy = all(patch.fy);
  const int side = window.side + 2;
  for (int x = 0; x < side; x += kShorts) {
    const std::uint8_t* pixels = patch.pixels + x;
    std::int16_t* out = window.samples + x;
    Shorts upper = betweenColumns<Window::kValueBits>(pixels, fx);
    for (int y = 0; y < side; ++y) {
      pixels += patch.step;
      const Shorts lower = betweenColumns<Window::kValueBits>(pixels, fx);
      store(out, betweenRows(upper, lower, fy));
      upper = lower;
      out += window.sample_stride;
    }
  }
}

}  // namespace

GradientSums takeWindow(const Patch& patch, const Window window) {
  // A gradient times a sampling offset is a value with 16 extra bits.
  constexpr int kUpToValue = 1 + Window::kValueBits - Window::kGradientBits;
  sample(patch, window);
  GradientSums sums = {0, 0, 0, 0, 0, 0};
  for (int x = 0; x < window.stride; x += kShorts) {
    const Shorts mask = load(window.mask + x);
    const Shorts spread_x = load(window.spread + x);
    const std::int16_t* spread_y = window.spread;
    Ints minus_value = noInts();
    Ints minus_x = noInts();
    Ints minus_y = noInts();
    Ints xx = noInts();
    Ints xy = noInts();
    Ints yy = noInts();
    const std::int16_t* above = window.samples + x;
    for (int at = x; at < window.side * window.stride; at += window.stride) {
      const std::int16_t* here = above + window.sample_stride;
      const std::int16_t* below = here + window.sample_stride;
      const Shorts gx = scharr(difference(above + 2, above),
                               difference(here + 2, here),
                               difference(below + 2, below)) &
                        mask;
      const Shorts gy = scharr(difference(below, above),
                               difference(below + 1, above + 1),
                               difference(below + 2, above + 2)) &
                        mask;
      const Shorts aside = multiplyHigh(shiftLeft<kUpToValue>(gx), spread_x);
      const Shorts down = multiplyHigh(shiftLeft<kUpToValue>(gy), all(*spread_y++));
      const Shorts value = load(here + 1) + aside + down;
      store(window.values + at, value);
      store(window.gradient_x + at, gx);
      store(window.gradient_y + at, gy);
      minus_value = minus_value + dot(value, mask);
      minus_x = minus_x + dot(gx, mask);
      minus_y = minus_y + dot(gy, mask);
      xx = xx + dot(gx, gx);
      xy = xy + dot(gx, gy);
      yy = yy + dot(gy, gy);
      above = here;
    }
    sums.value -= sum(minus_value);
    sums.x -= sum(minus_x);
    sums.y -= sum(minus_y);
    sums.xx += sum(xx);
    sums.xy += sum(xy);
    sums.yy += sum(yy);
  }
  return sums;
}

ContrastSums takeContrast(std::int16_t mean, const Window window) {
  constexpr int kShift = Window::kValueBits - Window::kContrastBits;
  const Shorts means = all(mean);
  ContrastSums sums = {0, 0, 0, 0};
  for (int x = 0; x < window.stride; x += kShorts) {
    const Shorts mask = load(window.mask + x);
    Ints minus_sum = noInts();
    Ints square = noInts();
    Ints sum_x = noInts();
    Ints sum_y = noInts();
    for (int at = x; at < window.side * window.stride; at += window.stride) {
      const Shorts contrast = shiftRight<kShift>(load(window.values + at) - means) & mask;
      store(window.contrast + at, contrast);
      minus_sum = minus_sum + dot(contrast, mask);
      square = square + dot(contrast, contrast);
      sum_x = sum_x + dot(contrast, load(window.gradient_x + at));
      sum_y = sum_y + dot(contrast, load(window.gradient_y + at));
    }
    sums.one -= sum(minus_sum);
    sums.square += sum(square);
    sums.x += sum(sum_x);
    sums.y += sum(sum_y);
  }
  return sums;
}

MismatchSums compareWindow(const Patch& patch, const Window& window) {
  const Shorts fx = all(patch.fx);
  const Shorts fy = all(patch.fy);
  constexpr int kShift = Window::kValueBits - MismatchSums::kDifferenceBits;
  MismatchSums sums = {0, 0, 0, 0, 0};
  for (int first = 0; first < window.side; first += kBlockRows) {
    const int last = first + kBlockRows < window.side ? first + kBlockRows : window.side;
    for (int x = 0; x < window.stride; x += kShorts) {
      const std::uint8_t* pixels = patch.pixels + first * patch.step + x;
      const Shorts mask = load(window.mask + x);
      Ints minus_sum = noInts();
      Ints sum_x = noInts();
      Ints sum_y = noInts();
      Ints contrast = noInts();
      Ints square = noInts();
      Shorts upper = betweenColumns<Window::kValueBits>(pixels, fx);
      const int end = last * window.stride;
      for (int at = first * window.stride + x; at < end; at += window.stride) {
        pixels += patch.step;
        const Shorts lower = betweenColumns<Window::kValueBits>(pixels, fx);
        const Shorts excess =
            shiftRight<kShift>(betweenRows(upper, lower, fy) - load(window.values + at)) & mask;
        minus_sum = minus_sum + dot(excess, mask);
        sum_x = sum_x + dot(excess, load(window.gradient_x + at));
        sum_y = sum_y + dot(excess, load(window.gradient_y + at));
        contrast = contrast + dot(excess, load(window.contrast + at));
        square = square + dot(excess, excess);
        upper = lower;
      }
      sums.one -= sum(minus_sum);
      sums.x += sum(sum_x);
      sums.y += sum(sum_y);
      sums.contrast += sum(contrast);
      sums.square += sum(square);
    }
  }
  return sums;
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
