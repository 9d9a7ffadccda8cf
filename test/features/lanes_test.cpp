// What the kernels add to the 128-bit registers of this processor, compared with its definition.

#include "kernels/lanes.h"

#include <cstdint>

#include <gtest/gtest.h>

namespace rotrocc::ROTROCC_INSTRUCTIONS {
namespace {

/// Expects each value of `actual` to be that of the function of its index.
template <class Definition>
void expectEach(const Shorts& actual, Definition expected) {
  std::int16_t values[kShorts];
  v_store(values, actual);
  for (int i = 0; i < kShorts; ++i) EXPECT_EQ(values[i], expected(i)) << i;
}

TEST(LanesTest, LoadAndStoreBytes) {
  std::uint8_t bytes[kShorts], stored[kShorts];
  std::int32_t ints[kShorts];
  for (int i = 0; i < kShorts; ++i) {
    bytes[i] = static_cast<std::uint8_t>(255 - 32 * i);
    ints[i] = bytes[i];
  }
  expectEach(loadBytes(bytes), [&](int i) { return bytes[i]; });
  storeBytes(stored, vx_load(ints), vx_load(ints + kInts));
  for (int i = 0; i < kShorts; ++i) EXPECT_EQ(stored[i], bytes[i]) << i;
}

TEST(LanesTest, Alternate) {
  expectEach(alternate(-5, 7), [](int i) { return i % 2 == 0 ? -5 : 7; });
}

TEST(LanesTest, ShiftLeft) {
  expectEach(shiftLeft<3>(alternate(-4095, 4095)),
             [](int i) { return i % 2 == 0 ? -32760 : 32760; });
}

TEST(LanesTest, SumBeyond32Bits) {
  EXPECT_EQ(sum(vx_setall_s32(2147483647)), kInts * std::int64_t{2147483647});
  EXPECT_EQ(sum(vx_setall_s32(-2147483647)), -kInts * std::int64_t{2147483647});
}

}  // namespace
}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
