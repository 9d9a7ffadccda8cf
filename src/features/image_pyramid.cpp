#include "features/image_pyramid.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <opencv2/imgproc.hpp>

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

/// Smooths every other pixel along row `y`, times 16, into `sums`, which has room for kMaxShorts.
/// `line` has room for the row and what is read beyond its ends.
void smoothAlong(const cv::Mat& image, int y, int columns, uchar* line, std::int16_t* sums) {
  const auto* row = image.ptr<uchar>(y);
  std::copy_n(row, image.cols, line + kReach);
  for (int i = 1; i <= kReach; ++i) {
    line[kReach - i] = row[inside(-i, image.cols)];
    line[kReach + image.cols - 1 + i] = row[inside(image.cols - 1 + i, image.cols)];
  }
  chooseKernels().smoothAlong(line + kReach, std::max(columns, kMaxShorts), sums);
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
  const int stride = half.cols + kMaxShorts;
  thread_local std::vector<std::int16_t> buffer;  // of kRows rows
  thread_local std::vector<uchar> line;
  buffer.resize(static_cast<std::size_t>(kRows * stride));
  line.resize(static_cast<std::size_t>(2 * stride + 2 * kReach));
  const auto smooth = [&](int y) { return buffer.data() + y % kRows * stride; };
  int next = 0;
  for (int y = 0; y < half.rows; ++y) {
    for (; next < std::min(2 * y + kReach + 1, image.rows); ++next) {
      smoothAlong(image, next, half.cols, line.data(), smooth(next));
    }
    const std::int16_t* rows[kRows];
    for (int i = 0; i < kRows; ++i) rows[i] = smooth(inside(2 * y + i - kReach, image.rows));
    chooseKernels().smoothDown(rows, half.cols, half.ptr<uchar>(y));
  }
}

void enlarge(const cv::Mat& image, cv::Mat& large) {
  const cv::Matx23d half(0.5, 0.0, 0.0, 0.0, 0.5, 0.0);
  constexpr int kFlags = cv::INTER_LINEAR | cv::WARP_INVERSE_MAP;
  cv::warpAffine(
      image, large, half, {2 * image.cols, 2 * image.rows}, kFlags, cv::BORDER_REPLICATE);
}

}  // namespace rotrocc
