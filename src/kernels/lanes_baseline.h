#pragma once

#include <cstdint>

#include <opencv2/core.hpp>
#include <opencv2/core/hal/intrin.hpp>

#include "kernels/instructions.h"

/// See lanes.h. 128 bits, using OpenCV's universal intrinsics.
namespace rotrocc::ROTROCC_INSTRUCTIONS {

using Shorts = cv::v_int16x8;
using Ints = cv::v_int32x4;
using Floats = cv::v_float32x4;
constexpr int kShorts = 8;
constexpr int kInts = 4;

inline Shorts load(const std::int16_t* from) {
  return cv::v_load(from);
}
inline Ints load(const std::int32_t* from) {
  return cv::v_load(from);
}
inline Floats load(const float* from) {
  return cv::v_load(from);
}
/// Loads bytes and widens them to 16 bits.
inline Shorts loadBytes(const std::uint8_t* from) {
  return cv::v_reinterpret_as_s16(cv::v_load_expand(from));
}

inline void store(std::int16_t* to, const Shorts& a) {
  cv::v_store(to, a);
}
inline void store(std::int32_t* to, const Ints& a) {
  cv::v_store(to, a);
}
inline void store(float* to, const Floats& a) {
  cv::v_store(to, a);
}

/// Stores the lowest bytes of `low`, then of `high`. All values must be 0 to 255.
inline void storeBytes(std::uint8_t* to, const Ints& low, const Ints& high) {
  cv::v_pack_u_store(to, cv::v_pack(low, high));
}

inline Shorts all(std::int16_t value) {
  return cv::v_setall_s16(value);
}
inline Floats all(float value) {
  return cv::v_setall_f32(value);
}
inline Ints all(std::int32_t value) {
  return cv::v_setall_s32(value);
}
/// a, b, a, b, ...
inline Shorts alternate(std::int16_t a, std::int16_t b) {
  return cv::v_reinterpret_as_s16(cv::v_setall_s32(
      static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::uint16_t>(b)) << 16 |
                                static_cast<std::uint16_t>(a))));
}
inline Ints noInts() {
  return cv::v_setzero_s32();
}

template <int kBits>
Shorts shiftLeft(const Shorts& a) {
  // Unsigned, because OpenCV's emulation shifts with <<.
  return cv::v_reinterpret_as_s16(cv::v_shl<kBits>(cv::v_reinterpret_as_u16(a)));
}
template <int kBits>
Shorts shiftRight(const Shorts& a) {
  return cv::v_shr<kBits>(a);
}
template <int kBits>
Ints shiftRight(const Ints& a) {
  return cv::v_shr<kBits>(a);
}
/// The upper 16 bits of the products. At most one factor may be -2^15.
inline Shorts multiplyHigh(const Shorts& a, const Shorts& b) {
  return cv::v_mul_hi(a, b);
}
/// Sums of the products of two neighbours.
inline Ints dot(const Shorts& a, const Shorts& b) {
  return cv::v_dotprod(a, b);
}
/// Adds a[i] b[i] + c[i] d[i] to each to[i].
inline void addProducts(
    const Shorts& a, const Shorts& b, const Shorts& c, const Shorts& d, std::int32_t* to) {
  Shorts ac_low, ac_high, bd_low, bd_high;
  cv::v_zip(a, c, ac_low, ac_high);
  cv::v_zip(b, d, bd_low, bd_high);
  store(to, load(to) + dot(ac_low, bd_low));
  store(to + kInts, load(to + kInts) + dot(ac_high, bd_high));
}

/// Adds a[i] b + c[i] d to sums that storePairs() puts in order. `bd`: b, d, b, d, ...
inline void addPairs(const Shorts& a, const Shorts& c, const Shorts& bd, Ints& low, Ints& high) {
  Shorts ac_low, ac_high;
  cv::v_zip(a, c, ac_low, ac_high);
  low = low + dot(ac_low, bd);
  high = high + dot(ac_high, bd);
}
/// The same of a[i]^2 + c[i]^2.
inline void addSquares(const Shorts& a, const Shorts& c, Ints& low, Ints& high) {
  Shorts ac_low, ac_high;
  cv::v_zip(a, c, ac_low, ac_high);
  low = low + dot(ac_low, ac_low);
  high = high + dot(ac_high, ac_high);
}
inline void storePairs(const Ints& low, const Ints& high, std::int32_t* to) {
  store(to, low);
  store(to + kInts, high);
}

inline std::int64_t sum(const Ints& a) {
  std::int32_t parts[kInts];
  store(parts, a);
  return std::int64_t{parts[0]} + parts[1] + parts[2] + parts[3];
}

inline Floats toFloats(const Ints& a) {
  return cv::v_cvt_f32(a);
}
inline Floats higher(const Floats& a, const Floats& b) {
  return cv::v_max(a, b);
}
/// One bit per lane, lowest lane first: 1 if a is at least b.
inline int atLeast(const Floats& a, const Floats& b) {
  return cv::v_signmask(a >= b);
}
inline Floats squareRoot(const Floats& a) {
  return cv::v_sqrt(a);
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
