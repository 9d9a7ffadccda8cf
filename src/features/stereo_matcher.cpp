#include "features/stereo_matcher.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "features/exposure.h"
#include "features/sad_costs.h"
#include "kernels/kernels.h"

namespace rotrocc {
namespace {

/// Costs within this distance [px] of the minimum are its slopes, not rivals.
constexpr int kSlope = 2;

constexpr float kNoColumn = -1.0F;

/// Initial capacity of the cost buffer, in columns.
constexpr std::size_t kUsualColumns = 256;

/// Whether windows in a row of the image can be read, including the pixels below.
bool rowInside(const cv::Mat& image, float row) {
  return row >= sad::kHalf && row < static_cast<float>(image.rows - sad::kHalf - 1);
}

/// Whether the window around a left pixel can be read, including the pixels to its right and below.
bool windowInside(const cv::Mat& image, const cv::Point2f& p) {
  return p.x >= sad::kHalf && p.x < static_cast<float>(image.cols - sad::kRegister) &&
         rowInside(image, p.y);
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

/// The exposure of the right image relative to the left one. Smaller differences are not corrected.
/// They hide a part of the bright matches, which is no loss: of four clips with a gain of 0.85, two
/// are more accurate without these and two with them.
Exposure exposureOfRight(const cv::Mat& left, const cv::Mat& right) {
  constexpr double kNotableGain = 0.2;
  constexpr double kNotableOffset = 25.0;
  const Exposure exposure = compareExposures(left, right);
  const bool is_notable =
      std::abs(exposure.gain - 1.0) >= kNotableGain || std::abs(exposure.offset) >= kNotableOffset;
  return is_notable ? exposure : Exposure();
}

/// The window of a left pixel, as the right camera would expose it. Saturated pixels remain so.
class ExposedWindow {
 public:
  ExposedWindow(const cv::Mat& left, const cv::Point& upper_left, const Exposure& of_right)
      : from_(left.ptr<uchar>(upper_left.y) + upper_left.x),
        step_(static_cast<std::ptrdiff_t>(left.step)) {
    if (of_right.gain != 1.0 || of_right.offset != 0.0) expose(of_right);
  }
  ExposedWindow(const ExposedWindow&) = delete;
  ExposedWindow& operator=(const ExposedWindow&) = delete;

  const uchar* pixels() const { return from_; }
  std::ptrdiff_t step() const { return step_; }

 private:
  void expose(const Exposure& of_right) {
    constexpr int kUnit = 256;
    constexpr int kSaturated = 250;
    const int gain = cvRound(kUnit * of_right.gain);
    const int offset = cvRound(kUnit * of_right.offset) + kUnit / 2;
    for (int y = 0; y < sad::kWindow; ++y) {
      const uchar* from = from_ + y * step_;
      for (int x = 0; x < kColumns; ++x) {
        const int exposed = std::clamp((from[x] * gain + offset) / kUnit, 0, 255);
        pixels_[y * kColumns + x] = static_cast<uchar>(from[x] < kSaturated ? exposed : from[x]);
      }
    }
    from_ = pixels_;
    step_ = kColumns;
  }

  static constexpr int kColumns = SadSearch::kReadPixels;
  const uchar* from_;
  std::ptrdiff_t step_;
  uchar pixels_[sad::kWindow * kColumns];
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

/// The gain from the left to the right image, at some of the pixels whose disparity is known.
double gainAt(const cv::Mat& left,
              const cv::Mat& right,
              const std::vector<cv::Point2f>& pixels,
              const std::vector<float>& disparities_px,
              double row_offset_px,
              double otherwise) {
  const auto lower_px = static_cast<float>(row_offset_px);
  thread_local WindowGain gain;
  gain.clear();
  const std::size_t step = WindowGain::step(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); i += step) {
    if (disparities_px[i] == StereoMatcher::kNoDisparity) continue;
    gain.add(left, pixels[i], right, pixels[i] + cv::Point2f(-disparities_px[i], lower_px));
  }
  return gain.median(otherwise);
}

}  // namespace

StereoMatcher::StereoMatcher(const Config& config) : config_(config), kernels_(&chooseKernels()) {}

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
  const double least_px = config_.min_disparity_px + infinity_px;
  const Exposure of_right = exposureOfRight(left, right);
  // Costs are in grey levels of the right image, their limit in those of the lighter one.
  const double most = config_.max_mean_difference * sad::kPixels * std::min(of_right.gain, 1.0);
  eachPixel(workers, corners, least_px, disparities_px, [&](std::size_t i) {
    if (!windowInside(left, corners[i])) return kNoColumn;
    const cv::Point pixel(cvRound(corners[i].x), cvRound(corners[i].y));
    const int right_row = pixel.y + rows_lower;
    if (!rowInside(right, static_cast<float>(right_row))) return kNoColumn;
    const cv::Range columns = clip(right, cv::Range(pixel.x - nearest - 1, pixel.x - farthest + 2));
    if (columns.size() < 3) return kNoColumn;
    const cv::Point upper_left = pixel - cv::Point(sad::kHalf, sad::kHalf);
    const ExposedWindow window(left, upper_left, of_right);
    const SadSearch search = {window.pixels(),
                              window.step(),
                              right.ptr<uchar>(right_row - sad::kHalf) + columns.start - sad::kHalf,
                              static_cast<std::ptrdiff_t>(right.step),
                              columns.size(),
                              most,
                              config_.uniqueness};
    return bestColumn(*kernels_, search, columns.start);
  });
  return gainAt(left, right, corners, disparities_px, rows_lower, of_right.gain);
}

double StereoMatcher::matchNear(Workers& workers,
                                const cv::Mat& left,
                                const cv::Mat& right,
                                const std::vector<cv::Point2f>& pixels,
                                const std::vector<float>& expected_px,
                                double infinity_px,
                                std::vector<float>& disparities_px,
                                double row_offset_px) const {
  const double gain = gainAt(left, right, pixels, expected_px, row_offset_px, 1.0);
  const double used = beyondNoise(gain, WindowGain::kStereoNoise);
  // Costs are in grey levels of the darker image.
  const double most = config_.max_mean_difference * sad::kPixels * std::min(used, 1.0 / used);
  const double least_px = config_.min_disparity_px + infinity_px;
  eachPixel(workers, pixels, least_px, disparities_px, [&](std::size_t i) {
    if (expected_px[i] == kNoDisparity || !windowInside(left, pixels[i])) return kNoColumn;
    const float right_row = pixels[i].y + static_cast<float>(row_offset_px);
    if (!rowInside(right, right_row)) return kNoColumn;
    const int x = cvRound(pixels[i].x - expected_px[i]);
    const cv::Range columns =
        clip(right, cv::Range(x - kNearRadius_px - 1, x + kNearRadius_px + 2));
    if (columns.size() < 3) return kNoColumn;
    return bestColumn(
        sad::SubPixelCosts(left, right, pixels[i], right_row, used, columns.start), columns, most);
  });
  return gain;
}

}  // namespace rotrocc
