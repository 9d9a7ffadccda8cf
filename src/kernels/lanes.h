#pragma once

/// Registers of 16-bit integers (Shorts), 32-bit integers (Ints, half as many) and floats (Floats):
/// OpenCV's universal intrinsics in the width of the processor, and what they lack. In the sources
/// for AVX2, they have 256 bits and a namespace of their own.
#if CV_AVX2
#include <immintrin.h>
#endif

#include <cstdint>

#include <opencv2/core.hpp>
#include <opencv2/core/hal/intrin.hpp>

#include "kernels/window_kernels.h"

namespace rotrocc::ROTROCC_INSTRUCTIONS {

using cv::v_shr;
using cv::vx_load;
using cv::vx_setall_f32;
using cv::vx_setall_s16;
using cv::vx_setall_s32;
using cv::vx_setzero_s32;

using Shorts = cv::v_int16;
using Ints = cv::v_int32;
using Floats = cv::v_float32;
constexpr int kShorts = sizeof(Shorts) / sizeof(std::int16_t);
constexpr int kInts = kShorts / 2;

/// Loads bytes and widens them to 16 bits.
inline Shorts loadBytes(const std::uint8_t* from) {
  return v_reinterpret_as_s16(cv::vx_load_expand(from));
}

/// kEven p[0] + kOdd p[1], kEven p[2] + kOdd p[3], ...; processors are little-endian.
template <int kEven, int kOdd>
Shorts sumPairs(const std::uint8_t* p) {
#if CV_AVX2
  const Shorts factors = vx_setall_s16(kEven + (kOdd << 8));
  return Shorts(_mm256_maddubs_epi16(vx_load(p).val, factors.val));
#else
  const Shorts pairs = v_reinterpret_as_s16(vx_load(p));
  const Shorts odd = v_reinterpret_as_s16(v_shr<8>(v_reinterpret_as_u16(pairs)));
  return v_mul_wrap(pairs & vx_setall_s16(255), vx_setall_s16(kEven)) +
         v_mul_wrap(odd, vx_setall_s16(kOdd));
#endif
}

/// a, b, a, b, ...
inline Shorts alternate(std::int16_t a, std::int16_t b) {
  return v_reinterpret_as_s16(vx_setall_s32(
      static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::uint16_t>(b)) << 16 |
                                static_cast<std::uint16_t>(a))));
}

template <int kBits>
Shorts shiftLeft(const Shorts& a) {
  // Unsigned, because OpenCV's emulation shifts with <<.
  return v_reinterpret_as_s16(cv::v_shl<kBits>(v_reinterpret_as_u16(a)));
}

inline std::int64_t sum(const Ints& a) {
  cv::v_int64 low, high;
  v_expand(a, low, high);
  std::int64_t parts[kInts / 2];
  v_store(parts, low + high);
  std::int64_t sum = 0;
  for (const std::int64_t part : parts) sum += part;
  return sum;
}

// Values between pixels, in units of 1 / 2^kBits gray levels.

/// Between each pixel and its right neighbor at fx / 2^15.
template <int kBits>
Shorts betweenColumns(const std::uint8_t* pixels, const Shorts& fx) {
  const Shorts left = loadBytes(pixels);
  const Shorts right = loadBytes(pixels + 1);
  return shiftLeft<kBits>(left) + v_mul_hi(shiftLeft<kBits + 1>(right - left), fx);
}

inline Shorts betweenRows(const Shorts& upper, const Shorts& lower, const Shorts& fy) {
  return upper + v_mul_hi(shiftLeft<1>(lower - upper), fy);
}

/// Samples a patch. Rows of `out` are written in whole registers.
template <int kBits>
void samplePatch(const Patch& patch, int columns, int rows, std::int16_t* out, int stride) {
  const Shorts fx = vx_setall_s16(patch.fx);
  const Shorts fy = vx_setall_s16(patch.fy);
  for (int x = 0; x < columns; x += kShorts) {
    const std::uint8_t* pixels = patch.pixels + x;
    Shorts upper = betweenColumns<kBits>(pixels, fx);
    for (int y = 0; y < rows; ++y) {
      pixels += patch.step;
      const Shorts lower = betweenColumns<kBits>(pixels, fx);
      v_store(out + y * stride + x, betweenRows(upper, lower, fy));
      upper = lower;
    }
  }
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
