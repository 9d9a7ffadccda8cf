#include "kernels/half_image_kernels.h"

#include "kernels/lanes.h"

namespace rotrocc::ROTROCC_INSTRUCTIONS {
namespace {

Shorts smooth(const Shorts& a, const Shorts& b, const Shorts& c, const Shorts& d, const Shorts& e) {
  return a + e + shiftLeft<2>(b + c + d) + c + c;
}

int smooth(int a, int b, int c, int d, int e) {
  return a + e + 4 * (b + c + d) + 2 * c;
}

}  // namespace

void smoothDown(const std::uint8_t* const* rows, int columns, std::int16_t* sums) {
  const std::uint8_t* a = rows[0];
  const std::uint8_t* b = rows[1];
  const std::uint8_t* c = rows[2];
  const std::uint8_t* d = rows[3];
  const std::uint8_t* e = rows[4];
  int x = 0;
  for (; x <= columns - kShorts; x += kShorts) {
    v_store(sums + x,
            smooth(loadBytes(a + x),
                   loadBytes(b + x),
                   loadBytes(c + x),
                   loadBytes(d + x),
                   loadBytes(e + x)));
  }
  for (; x < columns; ++x) {
    sums[x] = static_cast<std::int16_t>(smooth(a[x], b[x], c[x], d[x], e[x]));
  }
}

void smoothAlong(const std::int16_t* sums, int columns, std::uint8_t* out) {
  const Shorts first = alternate(1, 4);
  const Shorts middle = alternate(6, 4);
  const Shorts last = alternate(1, 0);
  const Ints rounding = vx_setall_s32(128);
  const auto smoothPairs = [&](const std::int16_t* at) {
    return v_shr<8>(v_dotprod(vx_load(at - 2), first) + v_dotprod(vx_load(at), middle) +
                    v_dotprod(vx_load(at + 2), last) + rounding);
  };
  int x = 0;
  for (; x <= columns - kShorts; x += kShorts, sums += 2 * kShorts) {
    storeBytes(out + x, smoothPairs(sums), smoothPairs(sums + kShorts));
  }
  for (; x < columns; ++x, sums += 2) {
    const int sum = smooth(sums[-2], sums[-1], sums[0], sums[1], sums[2]);
    out[x] = static_cast<std::uint8_t>((sum + 128) >> 8);
  }
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
