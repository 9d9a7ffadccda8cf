#include "features/stereo_matcher.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "features/sad_costs.h"
#include "kernels/kernels.h"

namespace rotrocc {
namespace {

/// Costs within this distance [px] of the minimum are its slopes, not rivals.
constexpr int kSlope = 2;

constexpr float kNoColumn = -1.0F;

/// Initial capacity of the cost buffer, in columns.
constexpr std::size_t kUsualColumns = 256;

/// Whether the window around a left pixel can be read, including the pixels to its right and below.
bool windowInside(const cv::Mat& image, const cv::Point2f& p) {
  return p.x >= sad::kHalf && p.y >= sad::kHalf &&
         p.x < static_cast<float>(image.cols - sad::kRegister) &&
         p.y < static_cast<float>(image.rows - sad::kHalf - 1);
}

/// The part of a range of right columns whose windows can be read.
cv::Range clip(const cv::Mat& image, const cv::Range& columns) {
  return {std::max(columns.start, sad::kHalf), std::min(columns.end, image.cols - sad::kRegister)};
}

/// Sub-pixel offset of the minimum of the costs at -1, 0 and 1. SAD changes linearly, so two lines
/// of equal slope fit better than a parabola.
float subPixelOffset(int before, int at, int after) {
  const int slope = std::max(before, after) - at;
  if (slope <= 0) return 0.0F;
  return 0.5F * static_cast<float>(before - after) / static_cast<float>(slope);
}

std::int16_t least(const std::int16_t* begin, const std::int16_t* end) {
  std::int16_t cost = SadSearch::kHigh;
  for (; begin < end; ++begin) cost = std::min(cost, *begin);
  return cost;
}

/// Brightness differences below this [grey levels] are not corrected: the match still costs much
/// less than the rest of the row.
constexpr int kNotable = 16;

/// Brightness difference, left minus right, due to the cameras' exposures: the median difference of
/// pixels [grey levels]. Parallax makes as many pixels brighter as darker.
int medianDifference(const cv::Mat& left, const cv::Mat& right) {
  constexpr int kStep_px = 8;
  constexpr int kMost = 255;
  std::array<int, 2 * kMost + 1> histogram{};
  int pixels = 0;
  for (int y = 0; y < left.rows; y += kStep_px) {
    const auto* in_left = left.ptr<uchar>(y);
    const auto* in_right = right.ptr<uchar>(y);
    for (int x = 0; x < left.cols; x += kStep_px, ++pixels) {
      ++histogram[static_cast<std::size_t>(kMost + in_left[x] - in_right[x])];
    }
  }
  int difference = -kMost;
  int below = histogram[0];
  while (2 * below < pixels) below += histogram[static_cast<std::size_t>(kMost + ++difference)];
  return difference;
}

/// The window of a left pixel with the brightness of the right camera.
class DarkenedWindow {
 public:
  static constexpr int kStep = SadSearch::kReadPixels;  // row length

  DarkenedWindow(const cv::Mat& left, const cv::Point& upper_left, int brighter) {
    for (int y = 0; y < sad::kWindow; ++y) {
      const auto* from = left.ptr<uchar>(upper_left.y + y) + upper_left.x;
      for (int x = 0; x < kStep; ++x) {
        pixels_[y * kStep + x] = static_cast<uchar>(std::clamp(from[x] - brighter, 0, 255));
      }
    }
  }
  const uchar* pixels() const { return pixels_; }

 private:
  uchar pixels_[sad::kWindow * kStep];
};

/// Column of the best match, where `first` is the first column searched. kNoColumn if the match is
/// at the end of the range, costs too much, or is ambiguous: at least `uniqueness` times the cost
/// of a rival.
float bestColumn(const Kernels& kernels, const SadSearch& search, int first) {
  thread_local std::vector<std::int16_t> buffer;
  std::vector<std::int16_t>& costs = buffer;  // one thread-local lookup
  costs.reserve(kUsualColumns);
  costs.resize(static_cast<std::size_t>(search.count + SadSearch::kGroup));
  kernels.sadCosts(search, costs.data());
  const std::int16_t* begin = costs.data();
  const std::int16_t* end = begin + search.count;
  const std::int16_t lowest = least(begin, end);
  const std::int16_t* best = std::find(begin, end, lowest);
  if (best == begin || best >= end - 1 || lowest > search.most) return kNoColumn;
  const std::int16_t* before = best - std::min<std::ptrdiff_t>(kSlope, best - begin);
  const std::int16_t* after = best + std::min<std::ptrdiff_t>(kSlope + 1, end - best);
  const std::int16_t rival = std::min(least(begin, before), least(after, end));
  if (rival != SadSearch::kHigh && lowest >= search.uniqueness * rival) return kNoColumn;
  const auto exact = [&](const std::int16_t* cost) -> int {
    return *cost != SadSearch::kHigh ? *cost
                                     : kernels.sadCost(search, static_cast<int>(cost - begin));
  };
  return static_cast<float>(first + static_cast<int>(best - begin)) +
         subPixelOffset(exact(best - 1), lowest, exact(best + 1));
}

/// As above, for a few columns and without a test for rivals.
float bestColumn(const sad::SubPixelCosts& costs_of, const cv::Range& columns, double most) {
  int costs[sad::SubPixelCosts::kColumns];
  for (int k = 0; k < columns.size(); ++k) costs[k] = costs_of(k);
  const int* best = std::min_element(costs, costs + columns.size());
  if (best == costs || best == costs + columns.size() - 1) return kNoColumn;
  if (*best > most * sad::SubPixelCosts::kUnit) return kNoColumn;
  return static_cast<float>(columns.start + static_cast<int>(best - costs)) +
         subPixelOffset(best[-1], best[0], best[1]);
}

/// Calls columnOf(i) for each pixel and converts the returned column to a disparity.
template <class ColumnOf>
void eachPixel(Workers& workers,
               const std::vector<cv::Point2f>& pixels,
               double least_px,
               std::vector<float>& disparities_px,
               const ColumnOf& columnOf) {
  disparities_px.assign(pixels.size(), StereoMatcher::kNoDisparity);
  workers.forEach(pixels.size(), [&](std::size_t i, std::size_t) {
    const float column = columnOf(i);
    const float disparity_px = pixels[i].x - column;
    if (column != kNoColumn && disparity_px >= least_px) disparities_px[i] = disparity_px;
  });
}

}  // namespace

StereoMatcher::StereoMatcher(const Config& config) : config_(config), kernels_(&chooseKernels()) {}

void StereoMatcher::match(Workers& workers,
                          const cv::Mat& left,
                          const cv::Mat& right,
                          const std::vector<cv::Point2f>& corners,
                          double infinity_px,
                          std::vector<float>& disparities_px) const {
  const int nearest = config_.max_disparity_px + cvCeil(infinity_px);
  const int farthest = cvFloor(config_.min_disparity_px + infinity_px);
  const double most = config_.max_mean_difference * sad::kPixels;
  const double least_px = config_.min_disparity_px + infinity_px;
  const int difference = medianDifference(left, right);
  const int brighter = std::abs(difference) < kNotable ? 0 : difference;
  eachPixel(workers, corners, least_px, disparities_px, [&](std::size_t i) {
    if (!windowInside(left, corners[i])) return kNoColumn;
    const cv::Point pixel(cvRound(corners[i].x), cvRound(corners[i].y));
    const cv::Range columns = clip(right, cv::Range(pixel.x - nearest - 1, pixel.x - farthest + 2));
    if (columns.size() < 3) return kNoColumn;
    const cv::Point upper_left = pixel - cv::Point(sad::kHalf, sad::kHalf);
    const DarkenedWindow window(left, upper_left, brighter);
    const SadSearch search = {window.pixels(),
                              DarkenedWindow::kStep,
                              right.ptr<uchar>(upper_left.y) + columns.start - sad::kHalf,
                              static_cast<std::ptrdiff_t>(right.step),
                              columns.size(),
                              most,
                              config_.uniqueness};
    return bestColumn(*kernels_, search, columns.start);
  });
}

void StereoMatcher::matchNear(Workers& workers,
                              const cv::Mat& left,
                              const cv::Mat& right,
                              const std::vector<cv::Point2f>& pixels,
                              const std::vector<float>& expected_px,
                              double infinity_px,
                              std::vector<float>& disparities_px) const {
  const double most = config_.max_mean_difference * sad::kPixels;
  const double least_px = config_.min_disparity_px + infinity_px;
  eachPixel(workers, pixels, least_px, disparities_px, [&](std::size_t i) {
    if (expected_px[i] == kNoDisparity || !windowInside(left, pixels[i])) return kNoColumn;
    const int x = cvRound(pixels[i].x - expected_px[i]);
    const cv::Range columns =
        clip(right, cv::Range(x - kNearRadius_px - 1, x + kNearRadius_px + 2));
    if (columns.size() < 3) return kNoColumn;
    return bestColumn(sad::SubPixelCosts(left, right, pixels[i], columns.start), columns, most);
  });
}

}  // namespace rotrocc
