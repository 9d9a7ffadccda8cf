#include "kernels/correlation_kernels.h"

#include "kernels/interpolation.h"

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
    Ints low = noInts();
    Ints high = noInts();
    for (const int y : W::kPartRows) {
      const std::int16_t* of_window = window + y * W::kStride + W::kPartFirst;
      const std::int16_t* row = strip + y * stride + W::kPartFirst + k;
      for (int x = 0; x < W::kPartWidth; x += 2) {
        addPairs(
            load(row + x), load(row + x + 1), alternate(of_window[x], of_window[x + 1]), low, high);
      }
    }
    storePairs(low, high, products + k);
  }
}

/// For each column of the strip, sums over the rows of a part: of values and of their squares.
void sumPartColumns(
    const std::int16_t* strip, int stride, int columns, std::int32_t* sums, std::int32_t* squares) {
  const Shorts one = all(std::int16_t{1});
  for (int x = 0; x < columns; x += kShorts) {
    Ints low = noInts();
    Ints high = noInts();
    Ints low_squares = noInts();
    Ints high_squares = noInts();
    for (int i = 0; i < W::kParts; i += 2) {
      const Shorts a = load(strip + W::kPartRows[i] * stride + x);
      const Shorts b = load(strip + W::kPartRows[i + 1] * stride + x);
      addPairs(a, b, one, low, high);
      addSquares(a, b, low_squares, high_squares);
    }
    storePairs(low, high, sums + x);
    storePairs(low_squares, high_squares, squares + x);
  }
}

/// Replaces the values by sums over kPartWidth neighbours.
void sumNeighbours(std::int32_t* values, int count) {
  static_assert(W::kPartWidth == 8);
  for (int x = 0; x < count + 6; ++x) values[x] += values[x + 1];
  for (int x = 0; x < count + 4; ++x) values[x] += values[x + 2];
  for (int x = 0; x < count; ++x) values[x] += values[x + 4];
}

}  // namespace

void widenRows(
    const std::uint8_t* pixels, std::ptrdiff_t step, int columns, std::int16_t* strip, int stride) {
  for (int y = 0; y < W::kSide; ++y, pixels += step, strip += stride) {
    for (int x = 0; x < columns; x += kShorts) store(strip + x, loadBytes(pixels + x));
  }
}

void sampleRows(const Patch& patch, int columns, std::int16_t* strip, int stride) {
  const Shorts fx = all(patch.fx);
  const Shorts fy = all(patch.fy);
  for (int x = 0; x < columns; x += kShorts) {
    const std::uint8_t* pixels = patch.pixels + x;
    Shorts upper = betweenColumns<W::kSampleBits>(pixels, fx);
    for (int y = 0; y < W::kSide; ++y) {
      pixels += patch.step;
      const Shorts lower = betweenColumns<W::kSampleBits>(pixels, fx);
      store(strip + y * stride + x, betweenRows(upper, lower, fy));
      upper = lower;
    }
  }
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
  sumNeighbours(sums, count);
  sumNeighbours(squares, count);
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
  float highest = correlations[0];
  int k = 0;
  Floats several = all(highest);
  for (; k + kInts <= count; k += kInts) several = higher(several, load(correlations + k));
  for (; k < count; ++k) highest = correlations[k] > highest ? correlations[k] : highest;
  float parts[kInts];
  store(parts, several);
  for (const float part : parts) highest = part > highest ? part : highest;
  return highest;
}

ProductSums multiplyWindow(const std::int16_t* window, const std::int16_t* strip, int stride) {
  Ints minus_b = noInts();
  Ints bb = noInts();
  Ints ab = noInts();
  for (int y = 0; y < W::kSide; ++y, window += W::kStride, strip += stride) {
    for (int x = 0; x < W::kStride; x += kShorts) {
      const Shorts mask = load(kMask + x);
      const Shorts values = load(strip + x);
      minus_b = minus_b + dot(values, mask);
      bb = bb + dot(values & mask, values);
      ab = ab + dot(values, load(window + x));
    }
  }
  return {-static_cast<std::int32_t>(sum(minus_b)),
          static_cast<std::int32_t>(sum(bb)),
          static_cast<std::int32_t>(sum(ab))};
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
