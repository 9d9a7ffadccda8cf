#include "features/image_pyramid.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "kernels/kernels.h"

namespace rotrocc {
namespace {

/// Radius of the kernel.
constexpr int kReach = 2;

constexpr int kRows = 2 * kReach + 1;

/// Reflects an index beyond the border.
int inside(int i, int count) {
  const int positive = std::abs(i);
  return positive < count ? positive : std::max(2 * (count - 1) - positive, 0);
}

/// Smooths every other pixel along row `y`, times 16, into `sums`.
void smoothAlong(
    const Kernels& kernels, const cv::Mat& image, int y, int columns, std::int16_t* sums) {
  const auto* row = image.ptr<uchar>(y);
  const auto pixel = [&](int x) { return row[inside(x, image.cols)]; };
  const int last = image.cols / 2 - 1;  // so far from the border
  const bool is_wide = last > kMaxShorts;
  if (is_wide) kernels.smoothAlong(row + 2, last - 1, sums + 1);
  for (int x = 0; x < columns; x = is_wide && x == 0 ? last : x + 1) {
    const int sides = pixel(2 * x - 1) + pixel(2 * x + 1);
    sums[x] = static_cast<std::int16_t>(pixel(2 * x - 2) + 4 * sides + 6 * pixel(2 * x) +
                                        pixel(2 * x + 2));
  }
}

}  // namespace

void buildPyramid(
    const cv::Mat& image, int levels, int min_side_px, ImagePyramid& pyramid, bool with_image) {
  int count = 1;
  while (count < levels && std::min(image.cols, image.rows) >> count > min_side_px) ++count;
  pyramid.resize(static_cast<std::size_t>(count));
  if (count > 1) halve(image, pyramid[1]);
  for (std::size_t i = 2; i < pyramid.size(); ++i) halve(pyramid[i - 1], pyramid[i]);
  if (with_image || count == 1) {
    image.copyTo(pyramid[0]);
  } else {
    pyramid[0].release();
  }
}

void halve(const cv::Mat& image, cv::Mat& half) {
  half.create((image.rows + 1) / 2, (image.cols + 1) / 2, CV_8UC1);
  const Kernels& kernels = chooseKernels();
  thread_local std::vector<std::int16_t> buffer;  // of kRows rows
  buffer.resize(static_cast<std::size_t>(kRows * half.cols));
  const auto smooth = [&](int y) { return buffer.data() + y % kRows * half.cols; };
  int next = 0;
  for (int y = 0; y < half.rows; ++y) {
    for (; next < std::min(2 * y + kReach + 1, image.rows); ++next) {
      smoothAlong(kernels, image, next, half.cols, smooth(next));
    }
    const std::int16_t* rows[kRows];
    for (int i = 0; i < kRows; ++i) rows[i] = smooth(inside(2 * y + i - kReach, image.rows));
    kernels.smoothDown(rows, half.cols, half.ptr<uchar>(y));
  }
}

void enlarge(const cv::Mat& image, cv::Mat& large) {
  const auto meanOf = [](int a, int b) { return static_cast<uchar>((a + b + 1) / 2); };
  large.create(2 * image.rows, 2 * image.cols, CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    const auto* row = image.ptr<uchar>(y);
    auto* out = large.ptr<uchar>(2 * y);
    for (int x = 0; x + 1 < image.cols; ++x) {
      out[2 * x] = row[x];
      out[2 * x + 1] = meanOf(row[x], row[x + 1]);
    }
    out[large.cols - 2] = out[large.cols - 1] = row[image.cols - 1];
  }
  for (int y = 1; y < large.rows; y += 2) {
    const auto* above = large.ptr<uchar>(y - 1);
    const auto* below = large.ptr<uchar>(std::min(y + 1, large.rows - 2));
    auto* out = large.ptr<uchar>(y);
    for (int x = 0; x < large.cols; ++x) out[x] = meanOf(above[x], below[x]);
  }
}

}  // namespace rotrocc
