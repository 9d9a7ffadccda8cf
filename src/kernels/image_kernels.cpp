#include "kernels/image_kernels.h"

#include <math.h>

#include "kernels/lanes.h"

namespace rotrocc::ROTROCC_INSTRUCTIONS {

void smoothAlong(const std::uint8_t* pixels, int columns, std::int16_t* sums) {
  const auto smooth = [&](int x) {
    const std::uint8_t* at = pixels + 2 * x;
    v_store(sums + x, sumPairs<1, 4>(at - 2) + sumPairs<6, 4>(at) + sumPairs<1, 0>(at + 2));
  };
  for (int x = 0; x < columns - kShorts; x += kShorts) smooth(x);
  smooth(columns - kShorts);
}

void smoothDown(const std::int16_t* const* rows, int columns, std::uint8_t* __restrict out) {
  for (int x = 0; x < columns; ++x) {
    const auto sum = static_cast<std::uint16_t>(rows[0][x] + 4 * (rows[1][x] + rows[3][x]) +
                                                6 * rows[2][x] + rows[4][x] + 128);
    out[x] = static_cast<std::uint8_t>(sum >> 8);
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
