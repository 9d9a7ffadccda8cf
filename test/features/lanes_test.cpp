// Compares the operations on 128-bit registers of this processor with their definitions.

#include "kernels/lanes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

namespace rotrocc::ROTROCC_INSTRUCTIONS {
namespace {

class LanesTest : public ::testing::Test {
 protected:
  LanesTest() {
    std::mt19937 random(1);
    for (std::int16_t* values : {a_, b_, c_, d_}) {
      for (int i = 0; i < kShorts; ++i) values[i] = static_cast<std::int16_t>(random());
    }
    for (int i = 0; i < 2 * kInts; ++i) {
      ints_[i] = static_cast<std::int32_t>(random());
      bytes_[i] = static_cast<std::uint8_t>(random());
      floats_[i] = std::ldexp(static_cast<float>(ints_[i]), -20);
    }
    // The extremes, but not both.
    a_[0] = -32768;
    b_[0] = 32767;
    a_[1] = 32767;
    b_[1] = -32768;
  }

  /// Expects each value of `actual` to be that of the function of its index.
  template <class Definition>
  static void expectEach(Shorts actual, Definition expected) {
    std::int16_t values[kShorts];
    store(values, actual);
    for (int i = 0; i < kShorts; ++i) EXPECT_EQ(values[i], expected(i)) << i;
  }
  template <class Definition>
  static void expectEach(Ints actual, Definition expected) {
    std::int32_t values[kInts];
    store(values, actual);
    for (int i = 0; i < kInts; ++i) EXPECT_EQ(values[i], expected(i)) << i;
  }
  template <class Definition>
  static void expectEach(Floats actual, Definition expected) {
    float values[kInts];
    store(values, actual);
    for (int i = 0; i < kInts; ++i) EXPECT_EQ(values[i], expected(i)) << i;
  }

  std::int16_t a_[kShorts], b_[kShorts], c_[kShorts], d_[kShorts];
  std::int32_t ints_[2 * kInts];
  std::uint8_t bytes_[kShorts];
  float floats_[2 * kInts];
};

TEST_F(LanesTest, LoadAndStore) {
  expectEach(load(a_), [&](int i) { return a_[i]; });
  expectEach(load(ints_), [&](int i) { return ints_[i]; });
  expectEach(load(floats_), [&](int i) { return floats_[i]; });
  expectEach(loadBytes(bytes_), [&](int i) { return bytes_[i]; });
  expectEach(alternate(-5, 7), [&](int i) { return i % 2 == 0 ? -5 : 7; });
  expectEach(all(std::int16_t{-9}), [&](int) { return -9; });
  expectEach(noInts(), [&](int) { return 0; });
  for (int i = 0; i < 2 * kInts; ++i) ints_[i] &= 255;
  std::uint8_t stored[2 * kInts];
  storeBytes(stored, load(ints_), load(ints_ + kInts));
  for (int i = 0; i < 2 * kInts; ++i) EXPECT_EQ(stored[i], ints_[i]) << i;
}

TEST_F(LanesTest, Shift) {
  const auto wrapped = [](int value) { return static_cast<std::int16_t>(value); };
  expectEach(shiftLeft<3>(load(a_)), [&](int i) { return wrapped(8 * a_[i]); });
  expectEach(shiftRight<3>(load(a_)), [&](int i) { return a_[i] >> 3; });
  expectEach(shiftRight<8>(load(ints_)), [&](int i) { return ints_[i] >> 8; });
}

TEST_F(LanesTest, Multiply) {
  expectEach(multiplyHigh(load(a_), load(b_)), [&](int i) { return a_[i] * b_[i] >> 16; });
}

TEST_F(LanesTest, MultiplyAndAdd) {
  // So that no sum overflows.
  const Shorts a = shiftRight<2>(load(a_));
  const auto product = [&](int i) { return (a_[i] >> 2) * b_[i]; };
  expectEach(dot(a, load(b_)), [&](int i) { return product(2 * i) + product(2 * i + 1); });

  std::int32_t sums[2 * kInts];
  for (int i = 0; i < 2 * kInts; ++i) sums[i] = ints_[i] >> 8;
  addProducts(a, load(b_), shiftRight<2>(load(c_)), load(d_), sums);
  for (int i = 0; i < 2 * kInts; ++i) {
    EXPECT_EQ(sums[i], (ints_[i] >> 8) + product(i) + (c_[i] >> 2) * d_[i]) << i;
  }
}

TEST_F(LanesTest, MultiplyByPairs) {
  const Shorts a = shiftRight<2>(load(a_));  // so that no sum overflows
  const Shorts c = shiftRight<2>(load(c_));
  Ints low = noInts();
  Ints high = noInts();
  addPairs(a, c, alternate(b_[0], b_[1]), low, high);
  addPairs(c, a, alternate(d_[0], d_[1]), low, high);
  std::int32_t sums[2 * kInts];
  storePairs(low, high, sums);
  for (int i = 0; i < 2 * kInts; ++i) {
    const std::int64_t expected =
        std::int64_t{a_[i] >> 2} * (b_[0] + d_[1]) + std::int64_t{c_[i] >> 2} * (b_[1] + d_[0]);
    EXPECT_EQ(sums[i], expected) << i;
  }
  low = high = noInts();
  addSquares(a, c, low, high);
  storePairs(low, high, sums);
  for (int i = 0; i < 2 * kInts; ++i) {
    EXPECT_EQ(sums[i], (a_[i] >> 2) * (a_[i] >> 2) + (c_[i] >> 2) * (c_[i] >> 2)) << i;
  }
}

TEST_F(LanesTest, SumBeyond32Bits) {
  EXPECT_EQ(sum(all(std::int32_t{2147483647})), kInts * std::int64_t{2147483647});
  EXPECT_EQ(sum(all(std::int32_t{-2147483647})), -kInts * std::int64_t{2147483647});
}

TEST_F(LanesTest, Floats) {
  const std::ptrdiff_t next = kInts;
  expectEach(toFloats(load(ints_)), [&](int i) { return static_cast<float>(ints_[i]); });
  expectEach(higher(load(floats_), load(floats_ + next)),
             [&](int i) { return std::max(floats_[i], floats_[i + next]); });
  floats_[1] = floats_[1 + next];
  int expected = 0;
  for (int i = 0; i < kInts; ++i) expected |= (floats_[i] >= floats_[i + next] ? 1 : 0) << i;
  EXPECT_EQ(atLeast(load(floats_), load(floats_ + next)), expected);
  for (float& value : floats_) value = std::abs(value);
  expectEach(squareRoot(load(floats_)), [&](int i) { return std::sqrt(floats_[i]); });
}

}  // namespace
}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
