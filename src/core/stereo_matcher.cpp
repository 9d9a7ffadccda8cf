#include "rotrocc/stereo_matcher.h"

#include <algorithm>
#include <cstdlib>

#include "sad_costs.h"

namespace rotrocc {
namespace {

/// The slopes of a minimum, so far to both sides [px], are no rivals of it.
constexpr int kSlope = 2;

/// Columns are dropped whose part of the window costs half as much again as where that is cheapest,
/// and two grey levels a pixel more. For 4 corners in 1000 of KITTI that changes the answer.
constexpr int kPartNoise = 64;

constexpr float kNoColumn = -1.0F;

/// Columns of a search that a buffer has room for from the beginning.
constexpr std::size_t kUsualColumns = 256;

/// Whether the window around a left pixel can be read, the pixels right of it and below included.
bool windowInside(const cv::Mat& image, const cv::Point2f& p) {
  return p.x >= sad::kHalf && p.y >= sad::kHalf &&
         p.x < static_cast<float>(image.cols - sad::kRegister) &&
         p.y < static_cast<float>(image.rows - sad::kHalf - 1);
}

/// The part of a range of right columns whose windows can be read.
cv::Range clip(const cv::Mat& image, const cv::Range& columns) {
  return {std::max(columns.start, sad::kHalf), std::min(columns.end, image.cols - sad::kRegister)};
}

/// Offset of the minimum of the costs at -1, 0 and 1. SAD falls and rises linearly, so two lines of
/// equal slope fit it better than a parabola.
float subPixelOffset(int before, int at, int after) {
  const int slope = std::max(before, after) - at;
  if (slope <= 0) return 0.0F;
  return 0.5F * static_cast<float>(before - after) / static_cast<float>(slope);
}

/// Column of the best match, or kNoColumn where it lies at the end of the range, costs more than
/// `most` or is ambiguous: at least `uniqueness` times the cost of a rival.
float bestColumn(const sad::WholePixelCosts& costs_of,
                 const cv::Range& columns,
                 double most,
                 double uniqueness) {
  thread_local std::vector<int> buffer;
  std::vector<int>& costs = buffer;  // looked up once
  costs.clear();
  costs.reserve(kUsualColumns);
  for (int x = columns.start; x < columns.end; ++x) costs.push_back(costs_of.part(x));
  const auto likely = std::min_element(costs.begin(), costs.end());
  const int likely_column = columns.start + static_cast<int>(likely - costs.begin());
  const int part_limit = *likely + *likely / 2 + kPartNoise;
  // What costs more can neither be the best nor a rival of it.
  const auto limitOf = [&](double best) { return cvCeil(std::min(best, most) / uniqueness); };
  int limit = limitOf(costs_of.whole(likely_column));
  int best = -1;
  int least = sad::kHigh;
  for (int k = 0; k < columns.size(); ++k) {
    int& cost = costs[static_cast<std::size_t>(k)];
    cost = cost <= part_limit ? costs_of.whole(columns.start + k, limit) : sad::kHigh;
    if (cost >= least) continue;
    best = k;
    least = cost;
    limit = std::min(limit, limitOf(least));
  }

  if (best <= 0 || best == columns.size() - 1 || least > most) return kNoColumn;
  for (int k = 0; k < columns.size(); ++k) {
    const bool rival = least >= uniqueness * costs[static_cast<std::size_t>(k)];
    if (rival && std::abs(k - best) > kSlope) return kNoColumn;
  }
  const auto exact = [&](int k) {
    const int cost = costs[static_cast<std::size_t>(k)];
    return cost != sad::kHigh ? cost : costs_of.whole(columns.start + k);
  };
  return static_cast<float>(columns.start + best) +
         subPixelOffset(exact(best - 1), least, exact(best + 1));
}

/// The same for a few columns, where rivals do not matter.
float bestColumn(const sad::SubPixelCosts& costs_of, const cv::Range& columns, double most) {
  int costs[sad::SubPixelCosts::kColumns];
  for (int k = 0; k < columns.size(); ++k) costs[k] = costs_of(k);
  const int* best = std::min_element(costs, costs + columns.size());
  if (best == costs || best == costs + columns.size() - 1) return kNoColumn;
  if (*best > most * sad::SubPixelCosts::kUnit) return kNoColumn;
  return static_cast<float>(columns.start + static_cast<int>(best - costs)) +
         subPixelOffset(best[-1], best[0], best[1]);
}

/// Calls columnOf(i) for each pixel and makes a disparity of the column that it returns.
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
  eachPixel(workers, corners, least_px, disparities_px, [&](std::size_t i) {
    if (!windowInside(left, corners[i])) return kNoColumn;
    const cv::Point pixel(cvRound(corners[i].x), cvRound(corners[i].y));
    const cv::Range columns = clip(right, cv::Range(pixel.x - nearest - 1, pixel.x - farthest + 2));
    if (columns.size() < 3) return kNoColumn;
    return bestColumn(sad::WholePixelCosts(left, right, pixel), columns, most, config_.uniqueness);
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
