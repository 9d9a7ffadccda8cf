#include "features/feature_detector.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "features/image_noise.h"
#include "features/min_texture.h"
#include "kernels/kernels.h"

namespace rotrocc {
namespace {

constexpr int kRowStep = CornerResponse::kRowStep;

/// Rows of a strip, in those of the response as all rows below. Constant, so that the strips do not
/// depend on the number of threads.
constexpr int kStripRows = 32;

/// The response that a corner needs: four times that to the noise of the image. Fine texture looks
/// like noise, as that of gravel, so no more noise is assumed than cameras have in the dark: 4 grey
/// levels.
float minResponse(double noise_variance) {
  constexpr double kOverNoise = 4.0;
  constexpr double kMaxDeviation = 4.0;
  constexpr double kSobelSquares = 12.0 / 64.0;  // of a gradient in grey levels per pixel
  const double variance = std::min(noise_variance, kMaxDeviation * kMaxDeviation);
  return std::max(kMinTexture, static_cast<float>(kOverNoise * kSobelSquares * variance));
}

/// Whether no pixel of these rows and columns has a response larger than `value`, or an equal one
/// if `beats_equal` is false.
bool isStrongest(const cv::Mat& response,
                 const cv::Range& rows,
                 const cv::Range& columns,
                 float value,
                 bool beats_equal) {
  const float most = beats_equal ? value : std::nextafter(value, -1.0F);
  for (int y = rows.start; y < rows.end; ++y) {
    const auto* row = response.ptr<float>(y);
    if (std::any_of(row + columns.start, row + columns.end, [&](float r) { return r > most; })) {
      return false;
    }
  }
  return true;
}

/// Whether no pixel within `radius_px` of (x, row) has a larger response, and none above or to the
/// left an equal one. Of equally strong corners, as in drawn patterns and saturated areas, the
/// first one counts. None in the rows of `band` is larger.
bool isFirstOfStrongest(
    const cv::Mat& response, int x, int row, int radius_px, const cv::Range& band) {
  const float value = response.at<float>(row, x);
  const cv::Range columns(x - radius_px, x + radius_px + 1);
  const int rows = radius_px / kRowStep;
  return isStrongest(response, {row - rows, band.start}, columns, value, false) &&
         isStrongest(response, {band.end, row + rows + 1}, columns, value, true) &&
         isStrongest(response, {band.start, row}, columns, value, false) &&
         isStrongest(response, {row, row + 1}, {columns.start, x}, value, false);
}

}  // namespace

FeatureDetector::FeatureDetector(const Config& config)
    : config_(config), kernels_(&chooseKernels()) {}

void FeatureDetector::detect(Workers& workers,
                             const cv::Mat& image,
                             std::vector<cv::Point2f>& corners,
                             int candidates) {
  corners.clear();
  if (std::min(image.cols, image.rows) <= 2 * (kBorder_px + kRadius_px)) return;

  min_response_ = minResponse(noiseVariance(image, noise_));
  const int first_row = (kBorder_px + kRowStep - 1) / kRowStep;
  const int last_row = (image.rows - kBorder_px + kRowStep - 1) / kRowStep;
  const int strip_count = (last_row + kStripRows - 1) / kStripRows;
  strips_.resize(static_cast<std::size_t>(strip_count));
  workers.run(strip_count, [&](int i) {
    const int first = std::max(i * kStripRows, first_row);
    const int last = std::min((i + 1) * kStripRows, last_row);
    findCandidates(image, first, last, strips_[static_cast<std::size_t>(i)]);
  });
  selectByCells(image.size(), static_cast<std::size_t>(candidates * config_.max_features), corners);
}

void FeatureDetector::findCandidates(const cv::Mat& image,
                                     int first_row,
                                     int last_row,
                                     Strip& strip) const {
  strip.candidates.clear();
  if (first_row >= last_row) return;
  const int rows = kRadius_px / kRowStep;
  strip.corner_response.compute(
      image, first_row - rows, last_row + rows, kRadius_px, strip.response);
  strip.highest.resize(static_cast<std::size_t>(strip.response.cols));
  const int band_rows = rows + 1;
  for (int first = first_row; first < last_row; first += band_rows) {
    searchBand(image.cols, {first, std::min(first + band_rows, last_row)}, first_row - rows, strip);
  }
}

/// Searches rows that are all within kRadius_px of each other. A corner must be the maximum of
/// its column in these rows, and no neighbouring column may have a larger one. Only these few
/// pixels are then compared with all their neighbours. The strip's response begins with row `top`.
void FeatureDetector::searchBand(int width, const cv::Range& rows, int top, Strip& strip) const {
  const int radius = kRadius_px;
  const cv::Range band(rows.start - top, rows.end - top);
  float* highest = strip.highest.data();
  kernels_->highestOfColumns(strip.response.ptr<float>(band.start),
                             static_cast<std::ptrdiff_t>(strip.response.step1()),
                             band.size(),
                             width + 2 * radius,
                             highest);
  strip.peaks.resize(strip.highest.size());
  const int count = kernels_->findPeaks(
      highest, kBorder_px, width - kBorder_px, radius, min_response_, strip.peaks.data());
  for (int i = 0; i < count; ++i) {
    const int x = strip.peaks[static_cast<std::size_t>(i)];
    const int column = x + radius;
    int row = band.start;
    while (strip.response.at<float>(row, column) != highest[column]) ++row;
    if (isFirstOfStrongest(strip.response, column, row, radius, band)) {
      strip.candidates.push_back({highest[column], x, kRowStep * (top + row)});
    }
  }
}

void FeatureDetector::selectByCells(const cv::Size& size,
                                    std::size_t max_count,
                                    std::vector<cv::Point2f>& corners) {
  sortByCells(size);
  for (std::size_t rank = 0; corners.size() < max_count; ++rank) {
    rank_.clear();
    std::size_t begin = 0;
    for (const std::size_t end : cell_ends_) {
      if (begin + rank < end) rank_.push_back(by_cell_[begin + rank]);
      begin = end;
    }
    if (rank_.empty()) break;
    std::sort(rank_.begin(), rank_.end(), isStronger);
    if (rank_.size() > max_count - corners.size()) rank_.resize(max_count - corners.size());
    for (const Candidate& c : rank_) {
      corners.emplace_back(static_cast<float>(c.x), static_cast<float>(c.y));
    }
  }
}

/// Sorts the candidates of all strips by cell, and within a cell by decreasing response.
void FeatureDetector::sortByCells(const cv::Size& size) {
  const double area_px2 = static_cast<double>(size.area()) / config_.max_features;
  const int side_px = std::max(1, cvRound(std::sqrt(area_px2)));
  const int columns = (size.width + side_px - 1) / side_px;
  const int rows = (size.height + side_px - 1) / side_px;
  const auto cellOf = [&](const Candidate& c) {
    return static_cast<std::size_t>((c.y / side_px) * columns + c.x / side_px);
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
