#pragma once

#include <arm_neon.h>

#include <cstdint>

#include "kernels/instructions.h"

/// See lanes.h. 128 bits, of 64-bit ARM. The compiler knows +, - , * and & of these types.
namespace rotrocc::ROTROCC_INSTRUCTIONS {

using Shorts = int16x8_t;
using Ints = int32x4_t;
using Floats = float32x4_t;
constexpr int kShorts = 8;
constexpr int kInts = 4;

inline Shorts load(const std::int16_t* from) {
  return vld1q_s16(from);
}
inline Ints load(const std::int32_t* from) {
  return vld1q_s32(from);
}
inline Floats load(const float* from) {
  return vld1q_f32(from);
}
inline Shorts loadBytes(const std::uint8_t* from) {
  return vreinterpretq_s16_u16(vmovl_u8(vld1_u8(from)));
}

inline void store(std::int16_t* to, Shorts a) {
  vst1q_s16(to, a);
}
inline void store(std::int32_t* to, Ints a) {
  vst1q_s32(to, a);
}
inline void store(float* to, Floats a) {
  vst1q_f32(to, a);
}

inline void storeBytes(std::uint8_t* to, Ints low, Ints high) {
  // The lower half of each value, of both registers.
  const uint16x8_t shorts = vuzp1q_u16(vreinterpretq_u16_s32(low), vreinterpretq_u16_s32(high));
  vst1_u8(to, vmovn_u16(shorts));
}

inline Shorts all(std::int16_t value) {
  return vdupq_n_s16(value);
}
inline Floats all(float value) {
  return vdupq_n_f32(value);
}
inline Ints all(std::int32_t value) {
  return vdupq_n_s32(value);
}
inline Shorts alternate(std::int16_t a, std::int16_t b) {
  return vzip1q_s16(vdupq_n_s16(a), vdupq_n_s16(b));
}
inline Ints noInts() {
  return vdupq_n_s32(0);
}

template <int kBits>
Shorts shiftLeft(Shorts a) {
  return vshlq_n_s16(a, kBits);
}
template <int kBits>
Shorts shiftRight(Shorts a) {
  return vshrq_n_s16(a, kBits);
}
template <int kBits>
Ints shiftRight(Ints a) {
  return vshrq_n_s32(a, kBits);
}
inline Shorts multiplyHigh(Shorts a, Shorts b) {
  // Twice the product, of which the processor has the upper half, must not overflow.
  return vshrq_n_s16(vqdmulhq_s16(a, b), 1);
}
template <int kBits>
Shorts multiplyHigh(Shorts a, Shorts b) {
  return vqdmulhq_s16(shiftLeft<kBits - 1>(a), b);
}
inline Ints dot(Shorts a, Shorts b) {
  return vpaddq_s32(vmull_s16(vget_low_s16(a), vget_low_s16(b)), vmull_high_s16(a, b));
}
inline Ints addDot(Ints sums, Shorts a, Shorts b) {
  return vmlal_high_s16(vmlal_s16(sums, vget_low_s16(a), vget_low_s16(b)), a, b);
}
inline void addProducts(Shorts a, Shorts b, Shorts c, Shorts d, std::int32_t* to) {
  const Ints low = vmlal_s16(load(to), vget_low_s16(a), vget_low_s16(b));
  const Ints high = vmlal_high_s16(load(to + kInts), a, b);
  store(to, vmlal_s16(low, vget_low_s16(c), vget_low_s16(d)));
  store(to + kInts, vmlal_high_s16(high, c, d));
}

inline Shorts twoOf(const std::int16_t* from) {
  return alternate(from[0], from[1]);
}
inline void addPairs(Shorts a, Shorts c, Shorts bd, Ints& low, Ints& high) {
  low = vaddq_s32(low, dot(vzip1q_s16(a, c), bd));
  high = vaddq_s32(high, dot(vzip2q_s16(a, c), bd));
}
inline void addSquares(Shorts a, Shorts c, Ints& low, Ints& high) {
  const Shorts ac_low = vzip1q_s16(a, c);
  const Shorts ac_high = vzip2q_s16(a, c);
  low = vaddq_s32(low, dot(ac_low, ac_low));
  high = vaddq_s32(high, dot(ac_high, ac_high));
}
inline void storePairs(Ints low, Ints high, std::int32_t* to) {
  store(to, low);
  store(to + kInts, high);
}

inline std::int64_t sum(Ints a) {
  return vaddlvq_s32(a);
}

inline Floats toFloats(Ints a) {
  return vcvtq_f32_s32(a);
}
inline Floats higher(Floats a, Floats b) {
  return vmaxq_f32(a, b);
}
inline int atLeast(Floats a, Floats b) {
  static constexpr std::uint32_t kBitOfLane[] = {1, 2, 4, 8};
  return static_cast<int>(vaddvq_u32(vandq_u32(vcgeq_f32(a, b), vld1q_u32(kBitOfLane))));
}
inline Floats squareRoot(Floats a) {
  return vsqrtq_f32(a);
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
