#include "features/feature_detector.h"

#include <algorithm>
#include <numeric>

#include "kernels/kernels.h"

namespace rotrocc {
namespace {

/// Rows of a strip. Constant, so that the strips do not depend on the number of threads.
constexpr int kStripRows = 64;

/// Whether no pixel within `radius` has a larger response, and none above or to the left an equal
/// one. Of equally strong corners, as in drawn patterns and saturated areas, the first one counts.
bool isFirstOfStrongest(const cv::Mat& response, int x, int y, int radius) {
  const float value = response.at<float>(y, x);
  for (int v = y - radius; v <= y + radius; ++v) {
    const auto* row = response.ptr<float>(v);
    const int middle = v < y ? x + radius + 1 : (v == y ? x : x - radius);
    for (int u = x - radius; u < middle; ++u) {
      if (row[u] >= value) return false;
    }
    for (int u = middle; u <= x + radius; ++u) {
      if (row[u] > value) return false;
    }
  }
  return true;
}

}  // namespace

FeatureDetector::FeatureDetector(const Config& config)
    : config_(config), kernels_(&chooseKernels()) {}

void FeatureDetector::detect(Workers& workers,
                             const cv::Mat& image,
                             std::vector<cv::Point2f>& corners) {
  corners.clear();
  if (std::min(image.cols, image.rows) <= 2 * (config_.border_px + config_.nms_radius_px)) return;

  const int strip_count = (image.rows + kStripRows - 1) / kStripRows;
  strips_.resize(static_cast<std::size_t>(strip_count), Strip(config_.block_radius_px));
  workers.run(strip_count, [&](int i) {
    const int first = std::max(i * kStripRows, config_.border_px);
    const int last = std::min((i + 1) * kStripRows, image.rows - config_.border_px);
    findCandidates(image, first, last, strips_[static_cast<std::size_t>(i)]);
  });
  selectByCells(image.size(), corners);
}

void FeatureDetector::findCandidates(const cv::Mat& image,
                                     int first_row,
                                     int last_row,
                                     Strip& strip) const {
  strip.candidates.clear();
  if (first_row >= last_row) return;
  const int radius = config_.nms_radius_px;
  strip.corner_response.compute(
      image, first_row - radius, last_row + radius, radius, strip.response);
  strip.highest.resize(static_cast<std::size_t>(strip.response.cols));
  const int band_rows = radius + 1;
  for (int y = first_row; y < last_row; y += band_rows) {
    searchBand(image.cols, y, std::min(y + band_rows, last_row), first_row - radius, strip);
  }
}

/// Searches rows [first, last) of the image, which are all within nms_radius_px of each other. A
/// corner must be the maximum of its column in these rows, and no neighbouring column may have a
/// larger one. Only these few pixels are then compared with all their neighbours. The strip's
/// response begins with row `top`.
void FeatureDetector::searchBand(int width, int first, int last, int top, Strip& strip) const {
  const int radius = config_.nms_radius_px;
  float* highest = strip.highest.data();
  kernels_->highestOfColumns(strip.response.ptr<float>(first - top),
                             static_cast<std::ptrdiff_t>(strip.response.step1()),
                             last - first,
                             width + 2 * radius,
                             highest);
  strip.peaks.resize(strip.highest.size());
  const int count = kernels_->findPeaks(highest,
                                        config_.border_px,
                                        width - config_.border_px,
                                        radius,
                                        static_cast<float>(config_.min_response),
                                        strip.peaks.data());
  for (int i = 0; i < count; ++i) {
    const int x = strip.peaks[static_cast<std::size_t>(i)];
    const int column = x + radius;
    int y = first;
    while (strip.response.at<float>(y - top, column) != highest[column]) ++y;
    if (isFirstOfStrongest(strip.response, column, y - top, radius)) {
      strip.candidates.push_back({highest[column], x, y});
    }
  }
}

void FeatureDetector::selectByCells(const cv::Size& size, std::vector<cv::Point2f>& corners) {
  sortByCells(size);
  const auto wanted = static_cast<std::size_t>(config_.max_features);
  for (std::size_t rank = 0; corners.size() < wanted; ++rank) {
    rank_.clear();
    std::size_t begin = 0;
    for (const std::size_t end : cell_ends_) {
      if (begin + rank < end) rank_.push_back(by_cell_[begin + rank]);
      begin = end;
    }
    if (rank_.empty()) break;
    std::sort(rank_.begin(), rank_.end(), isStronger);
    if (rank_.size() > wanted - corners.size()) rank_.resize(wanted - corners.size());
    for (const Candidate& c : rank_) {
      corners.emplace_back(static_cast<float>(c.x), static_cast<float>(c.y));
    }
  }
}

/// Sorts the candidates of all strips by cell, and within a cell by decreasing response.
void FeatureDetector::sortByCells(const cv::Size& size) {
  const int columns = (size.width + config_.cell_size_px - 1) / config_.cell_size_px;
  const int rows = (size.height + config_.cell_size_px - 1) / config_.cell_size_px;
  const auto cellOf = [&](const Candidate& c) {
    return static_cast<std::size_t>((c.y / config_.cell_size_px) * columns +
                                    c.x / config_.cell_size_px);
  };
  // These are the starts of the cells first. Each start moves to the cell's end as candidates are
  // added.
  cell_ends_.assign(static_cast<std::size_t>(columns * rows) + 1, 0);
  for (const Strip& strip : strips_) {
    for (const Candidate& c : strip.candidates) ++cell_ends_[cellOf(c) + 1];
  }
  std::partial_sum(cell_ends_.begin(), cell_ends_.end(), cell_ends_.begin());
  by_cell_.resize(cell_ends_.back());
  cell_ends_.pop_back();
  for (const Strip& strip : strips_) {
    for (const Candidate& c : strip.candidates) by_cell_[cell_ends_[cellOf(c)]++] = c;
  }
  auto begin = by_cell_.begin();
  for (const std::size_t cell_end : cell_ends_) {
    const auto end = by_cell_.begin() + static_cast<std::ptrdiff_t>(cell_end);
    std::sort(begin, end, isStronger);
    begin = end;
  }
}

/// Ties are broken by position, so that the order is deterministic.
bool FeatureDetector::isStronger(const Candidate& a, const Candidate& b) {
  if (a.response != b.response) return a.response > b.response;
  return a.y != b.y ? a.y < b.y : a.x < b.x;
}

}  // namespace rotrocc
