#include "kernels/image_kernels.h"

#include "kernels/lanes.h"

namespace rotrocc::ROTROCC_INSTRUCTIONS {
namespace {

/// Smaller eigenvalues of [xx xy; xy yy].
Floats smallerEigenvalues(const Floats& xx, const Floats& xy, const Floats& yy) {
  const Floats difference = xx - yy;
  const Floats root = v_sqrt(difference * difference + vx_setall_f32(4.0F) * xy * xy);
  return vx_setall_f32(0.5F) * (xx + yy - root);
}

/// Values of two registers in turn.
struct Zipped {
  Shorts low, high;
};

Zipped zip(const Shorts& first, const Shorts& second) {
  Zipped zipped;
  v_zip(first, second, zipped.low, zipped.high);
  return zipped;
}

Zipped withMinusSecond(const Zipped& a) {
  const Shorts signs = alternate(1, -1);
  return {v_mul_wrap(a.low, signs), v_mul_wrap(a.high, signs)};
}

/// Adds the products of the first values and those of the second ones.
void addProducts(const Zipped& a, const Zipped& b, std::int32_t* to) {
  v_store(to, vx_load(to) + v_dotprod(a.low, b.low));
  v_store(to + kInts, vx_load(to + kInts) + v_dotprod(a.high, b.high));
}

}  // namespace

void differentiateRow(const std::uint8_t* above,
                      const std::uint8_t* here,
                      const std::uint8_t* below,
                      int columns,
                      std::int16_t* smooth,
                      std::int16_t* steps) {
  int x = 0;
  for (; x <= columns - kShorts; x += kShorts) {
    const Shorts a = loadBytes(above + x);
    const Shorts h = loadBytes(here + x);
    const Shorts b = loadBytes(below + x);
    v_store(smooth + x, a + h + h + b);
    v_store(steps + x, b - a);
  }
  for (; x < columns; ++x) {
    smooth[x] = static_cast<std::int16_t>(above[x] + 2 * here[x] + below[x]);
    steps[x] = static_cast<std::int16_t>(below[x] - above[x]);
  }
}

void replaceGradients(const std::int16_t* smooth,
                      const std::int16_t* steps,
                      int columns,
                      std::int16_t* gradient_x,
                      std::int16_t* gradient_y,
                      ColumnSums sums) {
  for (int x = 0; x < columns; x += kShorts) {
    const Shorts middle = vx_load(steps + x + 1);
    const Shorts gx = vx_load(smooth + x + 2) - vx_load(smooth + x);
    const Shorts gy = vx_load(steps + x) + middle + middle + vx_load(steps + x + 2);
    const Zipped xs = zip(gx, vx_load(gradient_x + x));
    const Zipped ys = zip(gy, vx_load(gradient_y + x));
    const Zipped signed_xs = withMinusSecond(xs);
    const Zipped signed_ys = withMinusSecond(ys);
    addProducts(xs, signed_xs, sums.xx + x);
    addProducts(xs, signed_ys, sums.xy + x);
    addProducts(ys, signed_ys, sums.yy + x);
    v_store(gradient_x + x, gx);
    v_store(gradient_y + x, gy);
  }
}

void respondRow(ColumnSums sums, int columns, float* response) {
  constexpr int kSide = ColumnSums::kSide;
  // A slope of one grey level per pixel gives a Sobel gradient of 8.
  const Floats scale = vx_setall_f32(1.0F / (64.0F * static_cast<float>(kSide * kSide)));
  for (int x = 0; x < columns; x += kInts) {
    Ints xx = vx_load(sums.xx + x);
    Ints xy = vx_load(sums.xy + x);
    Ints yy = vx_load(sums.yy + x);
    for (int k = x + 1; k < x + kSide; ++k) {
      xx = xx + vx_load(sums.xx + k);
      xy = xy + vx_load(sums.xy + k);
      yy = yy + vx_load(sums.yy + k);
    }
    v_store(
        response + x,
        smallerEigenvalues(scale * v_cvt_f32(xx), scale * v_cvt_f32(xy), scale * v_cvt_f32(yy)));
  }
}

void highestOfColumns(
    const float* first, std::ptrdiff_t step, int rows, int columns, float* highest) {
  for (int x = 0; x < columns; x += kInts) {
    const float* row = first + x;
    Floats most = vx_load(row);
    for (int y = 1; y < rows; ++y) {
      row += step;
      most = v_max(most, vx_load(row));
    }
    v_store(highest + x, most);
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
