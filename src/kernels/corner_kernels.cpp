#include "kernels/corner_kernels.h"

#include "kernels/lanes.h"

namespace rotrocc::ROTROCC_INSTRUCTIONS {
namespace {

/// Smaller eigenvalues of [xx xy; xy yy].
Floats smallerEigenvalues(const Floats& xx, const Floats& xy, const Floats& yy) {
  const Floats difference = xx - yy;
  const Floats root = squareRoot(difference * difference + all(4.0F) * xy * xy);
  return all(0.5F) * (xx + yy - root);
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
    store(smooth + x, a + h + h + b);
    store(steps + x, b - a);
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
  const Shorts zero = all(std::int16_t{0});
  for (int x = 0; x < columns; x += kShorts) {
    const Shorts middle = load(steps + x + 1);
    const Shorts gx = load(smooth + x + 2) - load(smooth + x);
    const Shorts gy = load(steps + x) + middle + middle + load(steps + x + 2);
    const Shorts last_x = load(gradient_x + x);
    const Shorts last_y = load(gradient_y + x);
    const Shorts minus_last_x = zero - last_x;
    const Shorts minus_last_y = zero - last_y;
    addProducts(gx, gx, last_x, minus_last_x, sums.xx + x);
    addProducts(gx, gy, last_x, minus_last_y, sums.xy + x);
    addProducts(gy, gy, last_y, minus_last_y, sums.yy + x);
    store(gradient_x + x, gx);
    store(gradient_y + x, gy);
  }
}

void respondRow(ColumnSums sums, int side, int columns, float* response) {
  // A slope of one grey level per pixel gives a Sobel gradient of 8.
  const Floats scale = all(1.0F / (64.0F * static_cast<float>(side * side)));
  for (int x = 0; x < columns; x += kInts) {
    Ints xx = load(sums.xx + x);
    Ints xy = load(sums.xy + x);
    Ints yy = load(sums.yy + x);
    for (int k = x + 1; k < x + side; ++k) {
      xx = xx + load(sums.xx + k);
      xy = xy + load(sums.xy + k);
      yy = yy + load(sums.yy + k);
    }
    store(response + x,
          smallerEigenvalues(scale * toFloats(xx), scale * toFloats(xy), scale * toFloats(yy)));
  }
}

void highestOfColumns(
    const float* first, std::ptrdiff_t step, int rows, int columns, float* highest) {
  for (int x = 0; x < columns; x += kInts) {
    const float* row = first + x;
    Floats most = load(row);
    for (int y = 1; y < rows; ++y) {
      row += step;
      most = higher(most, load(row));
    }
    store(highest + x, most);
  }
}

int findPeaks(const float* highest, int first, int end, int radius, float least, int* peaks) {
  int count = 0;
  for (int x = first; x < end; x += kInts) {
    Floats most = all(least);
    for (int k = x; k <= x + 2 * radius; ++k) most = higher(most, load(highest + k));
    const int found = atLeast(load(highest + x + radius), most);
    if (found == 0) continue;
    for (int i = 0; i < kInts && x + i < end; ++i) {
      if ((found >> i & 1) != 0) peaks[count++] = x + i;
    }
  }
  return count;
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
