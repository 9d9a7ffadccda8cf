#include "kernels/image_kernels.h"

#include "kernels/lanes.h"

namespace rotrocc::ROTROCC_INSTRUCTIONS {
namespace {

Shorts smooth(const Shorts& a, const Shorts& b, const Shorts& c, const Shorts& d, const Shorts& e) {
  return a + e + shiftLeft<2>(b + c + d) + c + c;
}

int smooth(int a, int b, int c, int d, int e) {
  return a + e + 4 * (b + c + d) + 2 * c;
}

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
  // A slope of one gray level per pixel gives a Sobel gradient of 8.
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
