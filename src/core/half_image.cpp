#include "rotrocc/half_image.h"

#include <cstddef>
#include <vector>

#include <opencv2/core/hal/intrin.hpp>

namespace rotrocc {
namespace {

using Words = cv::v_uint16x8;
constexpr int kLanes = 8;

/// The kernel reaches so far.
constexpr int kReach = 2;

Words smooth(const Words& a, const Words& b, const Words& c, const Words& d, const Words& e) {
  return a + e + cv::v_shl<2>(b + c + d) + cv::v_shl<1>(c);
}

unsigned smooth(unsigned a, unsigned b, unsigned c, unsigned d, unsigned e) {
  return a + e + 4 * (b + c + d) + 2 * c;
}

/// Smooths the image downwards at row `y`, times 16, into `sums`, with its reflection on both
/// sides.
void smoothDown(const cv::Mat& image, int y, ushort* sums) {
  const uchar* rows[2 * kReach + 1];
  for (int i = -kReach; i <= kReach; ++i) {
    rows[i + kReach] =
        image.ptr<uchar>(cv::borderInterpolate(y + i, image.rows, cv::BORDER_REFLECT_101));
  }
  int x = 0;
  for (; x <= image.cols - kLanes; x += kLanes) {
    cv::v_store(sums + x,
                smooth(cv::v_load_expand(rows[0] + x),
                       cv::v_load_expand(rows[1] + x),
                       cv::v_load_expand(rows[2] + x),
                       cv::v_load_expand(rows[3] + x),
                       cv::v_load_expand(rows[4] + x)));
  }
  for (; x < image.cols; ++x) {
    sums[x] =
        static_cast<ushort>(smooth(rows[0][x], rows[1][x], rows[2][x], rows[3][x], rows[4][x]));
  }
  for (int i = 1; i <= kReach; ++i) {
    sums[-i] = sums[cv::borderInterpolate(-i, image.cols, cv::BORDER_REFLECT_101)];
    const int right = image.cols - 1 + i;
    sums[right] = sums[cv::borderInterpolate(right, image.cols, cv::BORDER_REFLECT_101)];
  }
}

/// Smooths what smoothDown() made along the row, and rounds every other pixel.
void smoothAlong(const ushort* sums, int columns, uchar* out) {
  const Words rounding = cv::v_setall_u16(128);
  int x = 0;
  for (; x <= columns - kLanes; x += kLanes, sums += 2 * kLanes) {
    Words a, b, c, d, e, beyond;
    cv::v_load_deinterleave(sums - 2, a, b);
    cv::v_load_deinterleave(sums, c, d);
    cv::v_load_deinterleave(sums + 2, e, beyond);
    cv::v_pack_store(out + x, cv::v_shr<8>(smooth(a, b, c, d, e) + rounding));
  }
  for (; x < columns; ++x, sums += 2) {
    const unsigned sum = smooth(sums[-2], sums[-1], sums[0], sums[1], sums[2]);
    out[x] = static_cast<uchar>((sum + 128) >> 8);
  }
}

}  // namespace

void halve(const cv::Mat& image, cv::Mat& half) {
  half.create((image.rows + 1) / 2, (image.cols + 1) / 2, CV_8UC1);
  thread_local std::vector<ushort> buffer;  // of a row
  buffer.resize(static_cast<std::size_t>(image.cols + 2 * kReach + 2 * kLanes));
  ushort* sums = buffer.data() + kReach;
  for (int y = 0; y < half.rows; ++y) {
    smoothDown(image, 2 * y, sums);
    smoothAlong(sums, half.cols, half.ptr<uchar>(y));
  }
}

}  // namespace rotrocc
