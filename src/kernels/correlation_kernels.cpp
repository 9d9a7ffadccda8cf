#include "kernels/correlation_kernels.h"

#include "kernels/lanes.h"

namespace rotrocc::ROTROCC_INSTRUCTIONS {
namespace {

using W = CorrelationWindow;
static_assert(W::kStride % kShorts == 0);

/// -1 for the pixels of a row of the window, then 0.
alignas(32) constexpr std::int16_t kMask[W::kStride] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};

/// Sums of products of the parts.
void multiplyParts(const std::int16_t* window,
                   const std::int16_t* strip,
                   int stride,
                   int count,
                   std::int32_t* products) {
  for (int k = 0; k < count; k += kShorts) {
    Ints even = vx_setzero_s32();
    Ints odd = vx_setzero_s32();
    for (const int y : W::kPartRows) {
      const std::int16_t* of_window = window + y * W::kStride + W::kPartFirst;
      const std::int16_t* row = strip + y * stride + W::kPartFirst + k;
      for (int x = 0; x < W::kPartWidth; x += 2) {
        const Shorts pair = alternate(of_window[x], of_window[x + 1]);
        even += v_dotprod(vx_load(row + x), pair);
        odd += v_dotprod(vx_load(row + x + 1), pair);
      }
    }
    Ints low, high;
    v_zip(even, odd, low, high);
    v_store(products + k, low);
    v_store(products + k + kInts, high);
  }
}

/// For each column of the strip, sums over the rows of a part: of values and of their squares.
void sumPartColumns(
    const std::int16_t* strip, int stride, int columns, std::int32_t* sums, std::int32_t* squares) {
  for (int x = 0; x < columns; ++x) {
    std::int32_t sum = 0;
    std::int32_t square = 0;
    for (const int y : W::kPartRows) {
      const std::int16_t value = strip[y * stride + x];
      sum += value;
      square += value * value;
    }
    sums[x] = sum;
    squares[x] = square;
  }
}

/// Replaces the values by sums over kPartWidth neighbors.
void sumNeighbors(std::int32_t* values, int count) {
  static_assert(W::kPartWidth == 8);
  for (int x = 0; x < count + 6; ++x) values[x] += values[x + 1];
  for (int x = 0; x < count + 4; ++x) values[x] += values[x + 2];
  for (int x = 0; x < count; ++x) values[x] += values[x + 4];
}

}  // namespace

void widenRows(
    const std::uint8_t* pixels, std::ptrdiff_t step, int columns, std::int16_t* strip, int stride) {
  for (int y = 0; y < W::kSide; ++y, pixels += step, strip += stride) {
    for (int x = 0; x < columns; x += kShorts) v_store(strip + x, loadBytes(pixels + x));
  }
}

void sampleRows(const Patch& patch, int columns, std::int16_t* strip, int stride) {
  samplePatch<W::kSampleBits>(patch, columns, W::kSide, strip, stride);
}

float correlateParts(const std::int16_t* window,
                     const std::int16_t* strip,
                     int stride,
                     int count,
                     float noise,
                     std::int32_t* scratch,
                     float* correlations) {
  std::int32_t* const products = scratch;
  std::int32_t* const sums = products + count + W::kScratchMargin;
  std::int32_t* const squares = sums + count + W::kScratchMargin;
  multiplyParts(window, strip, stride, count, products);
  sumPartColumns(strip + W::kPartFirst, stride, count + W::kPartWidth, sums, squares);
  sumNeighbors(sums, count);
  sumNeighbors(squares, count);
  std::int32_t own = 0;
  std::int32_t own_square = 0;
  for (const int y : W::kPartRows) {
    for (int x = W::kPartFirst; x < W::kPartFirst + W::kPartWidth; ++x) {
      const std::int32_t value = window[y * W::kStride + x];
      own += value;
      own_square += value * value;
    }
  }
  const float per_variance =
      1.0F / (static_cast<float>(W::kPartPixels * own_square - own * own) + noise);
  for (int k = 0; k < count; ++k) {
    const auto covariance = static_cast<float>(W::kPartPixels * products[k] - own * sums[k]);
    const auto variance = static_cast<float>(W::kPartPixels * squares[k] - sums[k] * sums[k]);
    const float magnitude = covariance < 0.0F ? -covariance : covariance;
    correlations[k] = covariance * magnitude / (variance + noise) * per_variance;
  }
  int k = 0;
  Floats several = vx_setall_f32(correlations[0]);
  for (; k + kInts <= count; k += kInts) several = v_max(several, vx_load(correlations + k));
  float highest = v_reduce_max(several);
  for (; k < count; ++k) highest = correlations[k] > highest ? correlations[k] : highest;
  return highest;
}

ProductSums multiplyWindow(const std::int16_t* window, const std::int16_t* strip, int stride) {
  Ints minus_b = vx_setzero_s32();
  Ints bb = vx_setzero_s32();
  Ints ab = vx_setzero_s32();
  for (int y = 0; y < W::kSide; ++y, window += W::kStride, strip += stride) {
    for (int x = 0; x < W::kStride; x += kShorts) {
      const Shorts mask = vx_load(kMask + x);
      const Shorts values = vx_load(strip + x) & mask;
      minus_b += v_dotprod(values, mask);
      bb += v_dotprod(values, values);
      ab += v_dotprod(values, vx_load(window + x));
    }
  }
  return {-v_reduce_sum(minus_b), v_reduce_sum(bb), v_reduce_sum(ab)};
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
