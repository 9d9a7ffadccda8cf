#include "kernels/image_kernels.h"

#include <math.h>

#include "kernels/lanes.h"

namespace rotrocc::ROTROCC_INSTRUCTIONS {

void smoothDown(const std::uint8_t* const* rows, int columns, std::int16_t* __restrict sums) {
  for (int x = 0; x < columns; ++x) {
    sums[x] = static_cast<std::int16_t>(rows[0][x] + 4 * (rows[1][x] + rows[3][x]) +
                                        6 * rows[2][x] + rows[4][x]);
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
    v_pack_u_store(out + x, v_pack(smoothPairs(sums), smoothPairs(sums + kShorts)));
  }
  for (; x < columns; ++x, sums += 2) {
    const int sum = sums[-2] + 4 * (sums[-1] + sums[1]) + 6 * sums[0] + sums[2];
    out[x] = static_cast<std::uint8_t>((sum + 128) >> 8);
  }
}

void differentiateRow(const std::uint8_t* above,
                      const std::uint8_t* here,
                      const std::uint8_t* below,
                      int columns,
                      std::int16_t* __restrict smooth,
                      std::int16_t* __restrict steps) {
  for (int x = 0; x < columns; ++x) {
    smooth[x] = static_cast<std::int16_t>(above[x] + 2 * here[x] + below[x]);
    steps[x] = static_cast<std::int16_t>(below[x] - above[x]);
  }
}

void replaceGradients(const std::int16_t* smooth,
                      const std::int16_t* steps,
                      int columns,
                      std::int16_t* __restrict gradient_x,
                      std::int16_t* __restrict gradient_y,
                      ColumnSums sums) {
  std::int32_t* __restrict xx = sums.xx;
  std::int32_t* __restrict xy = sums.xy;
  std::int32_t* __restrict yy = sums.yy;
  for (int x = 0; x < columns; ++x) {
    const auto gx = static_cast<std::int16_t>(smooth[x + 2] - smooth[x]);
    const auto gy = static_cast<std::int16_t>(steps[x] + 2 * steps[x + 1] + steps[x + 2]);
    const auto old_x = gradient_x[x];
    const auto old_y = gradient_y[x];
    xx[x] += static_cast<std::int16_t>(gx + old_x) * static_cast<std::int16_t>(gx - old_x);
    xy[x] += gx * gy - old_x * old_y;
    yy[x] += static_cast<std::int16_t>(gy + old_y) * static_cast<std::int16_t>(gy - old_y);
    gradient_x[x] = gx;
    gradient_y[x] = gy;
  }
}

void respondRow(ColumnSums sums, int columns, float* __restrict response) {
  constexpr int kSide = ColumnSums::kSide;
  // A slope of one gray level per pixel gives a Sobel gradient of 8.
  constexpr float kScale = 1.0F / (64.0F * static_cast<float>(kSide * kSide));
  const auto mean = [](const std::int32_t* at) {
    return kScale * static_cast<float>(at[0] + at[1] + at[2] + at[3] + at[4]);
  };
  static_assert(kSide == 5);
  for (int x = 0; x < columns; ++x) {
    const float xx = mean(sums.xx + x);
    const float xy = mean(sums.xy + x);
    const float yy = mean(sums.yy + x);
    const float root = sqrtf((xx - yy) * (xx - yy) + 4.0F * xy * xy);
    response[x] = 0.5F * (xx + yy - root);  // the smaller eigenvalue of [xx xy; xy yy]
  }
}

void highestOfColumns(
    const float* first, std::ptrdiff_t step, int rows, int columns, float* __restrict highest) {
  for (int x = 0; x < columns; ++x) highest[x] = first[x];
  for (int y = 1; y < rows; ++y) {
    first += step;
    for (int x = 0; x < columns; ++x) highest[x] = first[x] > highest[x] ? first[x] : highest[x];
  }
}

int findPeaks(const float* highest, int first, int end, int radius, float least, int* peaks) {
  int count = 0;
  for (int x = first; x < end; x += kInts) {
    const Floats value = vx_load(highest + x + radius);
    if (v_signmask(value >= vx_setall_f32(least)) == 0) continue;
    Floats most = vx_setall_f32(least);
    for (int k = x; k <= x + 2 * radius; ++k) most = v_max(most, vx_load(highest + k));
    const int found = v_signmask(value >= most);
    for (int i = 0; i < kInts && x + i < end; ++i) {
      if ((found >> i & 1) != 0) peaks[count++] = x + i;
    }
  }
  return count;
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
