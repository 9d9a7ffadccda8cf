#include "features/stereo_matcher.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "common/median.h"
#include "features/left_window.h"
#include "features/patch.h"
#include "kernels/kernels.h"

namespace rotrocc {
namespace {

using W = CorrelationWindow;

constexpr int kHalf = LeftWindow::kHalf;

/// Columns of a strip for which memory is reserved.
constexpr int kUsualColumns = 256;

/// Whether windows in a row of the image can be read, including the pixels below. Registers read on
/// into one more row.
bool rowInside(const cv::Mat& image, float row) {
  return row >= kHalf && row < static_cast<float>(image.rows - kHalf - 2);
}

/// Whether the window around a left pixel can be read, including the pixels to its right and below.
bool windowInside(const cv::Mat& image, const cv::Point2f& p) {
  return p.x >= kHalf && p.x < static_cast<float>(image.cols - W::kStride) && rowInside(image, p.y);
}

/// The part of a range of right columns whose windows can be read.
cv::Range clip(const cv::Mat& image, const cv::Range& columns) {
  return {std::max(columns.start, kHalf), std::min(columns.end, image.cols - W::kStride)};
}

/// Calls matchOf(i) for each pixel and converts the columns to disparities. Returns the median
/// gain.
template <class MatchOf>
double eachPixel(Workers& workers,
                 const std::vector<cv::Point2f>& pixels,
                 double min_px,
                 std::vector<float>& disparities_px,
                 const MatchOf& matchOf) {
  thread_local std::vector<float> gains;
  gains.assign(pixels.size(), 0.0F);
  float* const gain_of = gains.data();
  disparities_px.assign(pixels.size(), StereoMatcher::kNoDisparity);
  workers.forEach(pixels.size(), [&](std::size_t i, std::size_t) {
    const RowMatch match = matchOf(i);
    const float disparity_px = pixels[i].x - match.column;
    if (match.column == RowMatch::kNoColumn || disparity_px < min_px) return;
    disparities_px[i] = disparity_px;
    gain_of[i] = static_cast<float>(match.gain);
  });
  gains.erase(std::remove(gains.begin(), gains.end(), 0.0F), gains.end());
  return gains.empty() ? 1.0 : median(gains);
}

}  // namespace

StereoMatcher::StereoMatcher(const Config& config) : config_(config) {}

double StereoMatcher::match(Workers& workers,
                            const cv::Mat& left,
                            const cv::Mat& right,
                            const std::vector<cv::Point2f>& corners,
                            double infinity_px,
                            std::vector<float>& disparities_px,
                            double row_offset_px) const {
  const int rows_lower = cvRound(row_offset_px);
  const int nearest = config_.max_disparity_px + cvCeil(infinity_px);
  const int farthest = cvFloor(config_.min_disparity_px + infinity_px);
  const double min_px = config_.min_disparity_px + infinity_px;
  const Kernels& kernels = chooseKernels();
  return eachPixel(workers, corners, min_px, disparities_px, [&](std::size_t i) -> RowMatch {
    if (!windowInside(left, corners[i])) return {};
    const cv::Point pixel(cvRound(corners[i].x), cvRound(corners[i].y));
    const int right_row = pixel.y + rows_lower;
    if (!rowInside(right, static_cast<float>(right_row))) return {};
    const cv::Range columns = clip(right, cv::Range(pixel.x - nearest - 1, pixel.x - farthest + 2));
    if (columns.size() < 3) return {};
    thread_local RowBuffers buffers_of_thread;
    RowBuffers& buffers = buffers_of_thread;  // one look-up
    std::vector<std::int16_t>& strip = buffers.strip;
    const int stride = columns.size() + W::kStride + kMaxShorts;
    strip.reserve(W::kSide * kUsualColumns);
    strip.resize(static_cast<std::size_t>(W::kSide * stride + kMaxShorts));
    kernels.widenRows(right.ptr<uchar>(right_row - kHalf) + columns.start - kHalf,
                      static_cast<std::ptrdiff_t>(right.step),
                      columns.size() + W::kSide - 1,
                      strip.data(),
                      stride);
    RowMatch found =
        LeftWindow(kernels, left, pixel).searchRow(strip.data(), stride, columns.size(), buffers);
    if (found.column != RowMatch::kNoColumn) found.column += static_cast<float>(columns.start);
    return found;
  });
}

double StereoMatcher::matchNear(Workers& workers,
                                const cv::Mat& left,
                                const cv::Mat& right,
                                const std::vector<cv::Point2f>& pixels,
                                const std::vector<float>& expected_px,
                                double infinity_px,
                                std::vector<float>& disparities_px,
                                double row_offset_px) const {
  const double min_px = config_.min_disparity_px + infinity_px;
  const Kernels& kernels = chooseKernels();
  return eachPixel(workers, pixels, min_px, disparities_px, [&](std::size_t i) -> RowMatch {
    if (expected_px[i] == kNoDisparity || !windowInside(left, pixels[i])) return {};
    const float right_row = pixels[i].y + static_cast<float>(row_offset_px);
    if (!rowInside(right, right_row)) return {};
    const int x = cvRound(pixels[i].x - expected_px[i]);
    const cv::Range columns =
        clip(right, cv::Range(x - kNearRadius_px - 1, x + kNearRadius_px + 2));
    if (columns.size() < 3) return {};
    constexpr int kStride = 2 * W::kStride;
    std::int16_t strip[W::kSide * kStride];
    kernels.sampleRows(patchAt(right, {static_cast<float>(columns.start), right_row}, kHalf),
                       columns.size() + W::kSide - 1,
                       strip,
                       kStride);
    RowMatch found =
        LeftWindow(kernels, left, pixels[i]).searchNear(strip, kStride, columns.size());
    if (found.column != RowMatch::kNoColumn) found.column += static_cast<float>(columns.start);
    return found;
  });
}

}  // namespace rotrocc
