#include "features/image_pyramid.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/kernels.h"

namespace rotrocc {
namespace {

/// Radius of the kernel.
constexpr int kReach = 2;

/// Smooths the image vertically at row `y`, times 16, into `sums`, and reflects it on both sides.
void smoothDown(const Kernels& kernels, const cv::Mat& image, int y, std::int16_t* sums) {
  const auto inside = [](int i, int count) {
    return i >= 0 && i < count ? i : cv::borderInterpolate(i, count, cv::BORDER_REFLECT_101);
  };
  const uchar* rows[2 * kReach + 1];
  for (int i = -kReach; i <= kReach; ++i) {
    rows[i + kReach] = image.ptr<uchar>(inside(y + i, image.rows));
  }
  kernels.smoothDown(rows, image.cols, sums);
  for (const int x : {-2, -1, image.cols, image.cols + 1}) sums[x] = sums[inside(x, image.cols)];
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
  thread_local std::vector<std::int16_t> buffer;  // buffer for one row
  buffer.resize(static_cast<std::size_t>(image.cols + 2 * kReach + kMaxShorts));
  std::int16_t* sums = buffer.data() + kReach;
  for (int y = 0; y < half.rows; ++y) {
    smoothDown(kernels, image, 2 * y, sums);
    kernels.smoothAlong(sums, half.cols, half.ptr<uchar>(y));
  }
}

}  // namespace rotrocc
