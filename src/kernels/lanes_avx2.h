#pragma once

#include <immintrin.h>

#include <cstdint>

#include "kernels/instructions.h"

/// See lanes.h. 256 bits.
namespace rotrocc::ROTROCC_INSTRUCTIONS {

struct Shorts {
  __m256i bits;
};
struct Ints {
  __m256i bits;
};
struct Floats {
  __m256 bits;
};
constexpr int kShorts = 16;
constexpr int kInts = 8;

inline Shorts load(const std::int16_t* from) {
  return {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from))};
}
inline Ints load(const std::int32_t* from) {
  return {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from))};
}
inline Floats load(const float* from) {
  return {_mm256_loadu_ps(from)};
}
inline Shorts loadBytes(const std::uint8_t* from) {
  return {_mm256_cvtepu8_epi16(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from)))};
}

inline void store(std::int16_t* to, Shorts a) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), a.bits);
}
inline void store(std::int32_t* to, Ints a) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), a.bits);
}
inline void store(float* to, Floats a) {
  _mm256_storeu_ps(to, a.bits);
}

inline void storeBytes(std::uint8_t* to, Ints low, Ints high) {
  // AVX2 packs the two halves of a register separately.
  const __m256i mixed = _mm256_packs_epi32(low.bits, high.bits);
  const __m256i shorts = _mm256_permute4x64_epi64(mixed, 0xd8);
  _mm_storeu_si128(
      reinterpret_cast<__m128i*>(to),
      _mm_packus_epi16(_mm256_castsi256_si128(shorts), _mm256_extracti128_si256(shorts, 1)));
}

inline Shorts all(std::int16_t value) {
  return {_mm256_set1_epi16(value)};
}
inline Floats all(float value) {
  return {_mm256_set1_ps(value)};
}
inline Ints all(std::int32_t value) {
  return {_mm256_set1_epi32(value)};
}
inline Shorts alternate(std::int16_t a, std::int16_t b) {
  return {_mm256_setr_epi16(a, b, a, b, a, b, a, b, a, b, a, b, a, b, a, b)};
}
inline Ints noInts() {
  return {_mm256_setzero_si256()};
}

inline Shorts operator+(Shorts a, Shorts b) {
  return {_mm256_add_epi16(a.bits, b.bits)};
}
inline Shorts operator-(Shorts a, Shorts b) {
  return {_mm256_sub_epi16(a.bits, b.bits)};
}
inline Shorts operator&(Shorts a, Shorts b) {
  return {_mm256_and_si256(a.bits, b.bits)};
}
inline Ints operator+(Ints a, Ints b) {
  return {_mm256_add_epi32(a.bits, b.bits)};
}
inline Floats operator+(Floats a, Floats b) {
  return {_mm256_add_ps(a.bits, b.bits)};
}
inline Floats operator-(Floats a, Floats b) {
  return {_mm256_sub_ps(a.bits, b.bits)};
}
inline Floats operator*(Floats a, Floats b) {
  return {_mm256_mul_ps(a.bits, b.bits)};
}

template <int kBits>
Shorts shiftLeft(Shorts a) {
  return {_mm256_slli_epi16(a.bits, kBits)};
}
template <int kBits>
Shorts shiftRight(Shorts a) {
  return {_mm256_srai_epi16(a.bits, kBits)};
}
template <int kBits>
Ints shiftRight(Ints a) {
  return {_mm256_srai_epi32(a.bits, kBits)};
}
inline Shorts multiplyHigh(Shorts a, Shorts b) {
  return {_mm256_mulhi_epi16(a.bits, b.bits)};
}
inline Ints dot(Shorts a, Shorts b) {
  return {_mm256_madd_epi16(a.bits, b.bits)};
}
inline void addProducts(Shorts a, Shorts b, Shorts c, Shorts d, std::int32_t* to) {
  // AVX2 unpacks the two halves of a register separately: 0 to 3 and 8 to 11, then the others.
  const __m256i even = _mm256_madd_epi16(_mm256_unpacklo_epi16(a.bits, c.bits),
                                         _mm256_unpacklo_epi16(b.bits, d.bits));
  const __m256i odd = _mm256_madd_epi16(_mm256_unpackhi_epi16(a.bits, c.bits),
                                        _mm256_unpackhi_epi16(b.bits, d.bits));
  store(to, load(to) + Ints{_mm256_permute2x128_si256(even, odd, 0x20)});
  store(to + kInts, load(to + kInts) + Ints{_mm256_permute2x128_si256(even, odd, 0x31)});
}

inline void addPairs(Shorts a, Shorts c, Shorts bd, Ints& low, Ints& high) {
  low = low + dot({_mm256_unpacklo_epi16(a.bits, c.bits)}, bd);
  high = high + dot({_mm256_unpackhi_epi16(a.bits, c.bits)}, bd);
}
inline void addSquares(Shorts a, Shorts c, Ints& low, Ints& high) {
  const Shorts ac_low = {_mm256_unpacklo_epi16(a.bits, c.bits)};
  const Shorts ac_high = {_mm256_unpackhi_epi16(a.bits, c.bits)};
  low = low + dot(ac_low, ac_low);
  high = high + dot(ac_high, ac_high);
}
inline void storePairs(Ints low, Ints high, std::int32_t* to) {
  store(to, Ints{_mm256_permute2x128_si256(low.bits, high.bits, 0x20)});
  store(to + kInts, Ints{_mm256_permute2x128_si256(low.bits, high.bits, 0x31)});
}

inline std::int64_t sum(Ints a) {
  const __m256i pairs =
      _mm256_add_epi64(_mm256_cvtepi32_epi64(_mm256_castsi256_si128(a.bits)),
                       _mm256_cvtepi32_epi64(_mm256_extracti128_si256(a.bits, 1)));
  const __m128i two =
      _mm_add_epi64(_mm256_castsi256_si128(pairs), _mm256_extracti128_si256(pairs, 1));
  std::int64_t parts[2];
  _mm_storeu_si128(reinterpret_cast<__m128i*>(parts), two);
  return parts[0] + parts[1];
}

inline Floats toFloats(Ints a) {
  return {_mm256_cvtepi32_ps(a.bits)};
}
inline Floats higher(Floats a, Floats b) {
  return {_mm256_max_ps(a.bits, b.bits)};
}
inline int atLeast(Floats a, Floats b) {
  return _mm256_movemask_ps(_mm256_cmp_ps(a.bits, b.bits, _CMP_GE_OQ));
}
inline Floats squareRoot(Floats a) {
  return {_mm256_sqrt_ps(a.bits)};
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
