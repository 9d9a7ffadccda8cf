#include "rotrocc/feature_detector.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace rotrocc {
namespace {

/// Rows of a strip. Fixed, so that the same strips are computed whatever the number of threads.
constexpr int kStripRows = 64;

/// Adds `window` neighbours to the right: sums[x] = values[x] + ... + values[x + window - 1].
void sumAlongRow(const int* values, int count, int window, int* sums) {
  for (int x = 0; x < count; ++x) sums[x] = values[x];
  for (int k = 1; k < window; ++k) {
    for (int x = 0; x < count; ++x) sums[x] += values[x + k];
  }
}

/// Smaller eigenvalue of [xx xy; xy yy].
float smallerEigenvalue(float xx, float xy, float yy) {
  const float difference = xx - yy;
  return 0.5F * (xx + yy - std::sqrt(difference * difference + 4.0F * xy * xy));
}

/// Whether a pixel above or to the left, within `radius`, has the same response. Of corners that
/// are exactly alike, as in drawn patterns and saturated areas, the first one counts.
bool hasEarlierTwin(const cv::Mat& response, int x, int y, int radius) {
  const float value = response.at<float>(y, x);
  for (int v = std::max(y - radius, 0); v <= y; ++v) {
    const auto* row = response.ptr<float>(v);
    const int end = v < y ? std::min(x + radius + 1, response.cols) : x;
    for (int u = std::max(x - radius, 0); u < end; ++u) {
      if (row[u] == value) return true;
    }
  }
  return false;
}

}  // namespace

void FeatureDetector::detect(const cv::Mat& image, std::vector<cv::Point2f>& corners) {
  corners.clear();
  if (std::min(image.cols, image.rows) <= 2 * (config_.border_px + config_.nms_radius_px)) return;

  const int strip_count = (image.rows + kStripRows - 1) / kStripRows;
  strips_.resize(static_cast<std::size_t>(strip_count));
  cv::parallel_for_(cv::Range(0, strip_count), [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const int first = std::max(i * kStripRows, config_.border_px);
      const int last = std::min((i + 1) * kStripRows, image.rows - config_.border_px);
      findCandidates(image, first, last, strips_[static_cast<std::size_t>(i)]);
    }
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
  const int margin = radius + config_.block_radius_px + 1;
  const int top = std::max(first_row - margin, 0);
  const int bottom = std::min(last_row + margin, image.rows);
  computeResponse(image.rowRange(top, bottom), strip);

  const cv::Mat neighbourhood =
      cv::getStructuringElement(cv::MORPH_RECT, cv::Size(2 * radius + 1, 2 * radius + 1));
  cv::dilate(strip.response, strip.maximum, neighbourhood);
  const auto least = static_cast<float>(config_.min_response);
  for (int y = first_row; y < last_row; ++y) {
    const auto* response = strip.response.ptr<float>(y - top);
    const auto* maximum = strip.maximum.ptr<float>(y - top);
    for (int x = config_.border_px; x < image.cols - config_.border_px; ++x) {
      if (response[x] >= least && response[x] == maximum[x] &&
          !hasEarlierTwin(strip.response, x, y - top, radius)) {
        strip.candidates.push_back({response[x], x, y});
      }
    }
  }
}

void FeatureDetector::computeResponse(const cv::Mat& image, Strip& strip) const {
  cv::Sobel(image, strip.gradient_x, CV_16S, 1, 0, 3, 1, 0, cv::BORDER_REPLICATE);
  cv::Sobel(image, strip.gradient_y, CV_16S, 0, 1, 3, 1, 0, cv::BORDER_REPLICATE);

  const int half = config_.block_radius_px;
  const int block = 2 * half + 1;
  const int width = image.cols;
  strip.response.create(image.size(), CV_32F);
  strip.response.setTo(0.0F);
  // Rows of `sums`: the products xx, xy, yy summed over the block's rows, then along the row as
  // well. Integers: the running sums over rows stay exact.
  strip.sums.create(6, width, CV_32S);
  strip.sums.setTo(0);
  int* column_sums[3] = {strip.sums.ptr<int>(0), strip.sums.ptr<int>(1), strip.sums.ptr<int>(2)};
  int* block_sums[3] = {strip.sums.ptr<int>(3), strip.sums.ptr<int>(4), strip.sums.ptr<int>(5)};
  const auto add_row = [&](int y, int sign) {
    const auto* gx = strip.gradient_x.ptr<short>(y);
    const auto* gy = strip.gradient_y.ptr<short>(y);
    for (int x = 0; x < width; ++x) {
      column_sums[0][x] += sign * gx[x] * gx[x];
      column_sums[1][x] += sign * gx[x] * gy[x];
      column_sums[2][x] += sign * gy[x] * gy[x];
    }
  };

  // A Sobel gradient is 8 grey levels for a slope of one level per pixel.
  const float scale = 1.0F / (64.0F * static_cast<float>(block * block));
  for (int y = 0; y < image.rows; ++y) {
    add_row(y, 1);
    if (y >= block) add_row(y - block, -1);
    if (y < block - 1) continue;
    const int count = width - block + 1;
    for (int i = 0; i < 3; ++i) sumAlongRow(column_sums[i], count, block, block_sums[i]);
    float* response = strip.response.ptr<float>(y - half) + half;
    for (int x = 0; x < count; ++x) {
      response[x] = smallerEigenvalue(scale * static_cast<float>(block_sums[0][x]),
                                      scale * static_cast<float>(block_sums[1][x]),
                                      scale * static_cast<float>(block_sums[2][x]));
    }
  }
}

void FeatureDetector::selectByCells(const cv::Size& size, std::vector<cv::Point2f>& corners) {
  const int columns = (size.width + config_.cell_size_px - 1) / config_.cell_size_px;
  const int rows = (size.height + config_.cell_size_px - 1) / config_.cell_size_px;
  cells_.resize(static_cast<std::size_t>(columns * rows));
  for (auto& cell : cells_) cell.clear();
  for (const Strip& strip : strips_) {
    for (const Candidate& c : strip.candidates) {
      const int cell = (c.y / config_.cell_size_px) * columns + c.x / config_.cell_size_px;
      cells_[static_cast<std::size_t>(cell)].push_back(c);
    }
  }

  // Ties are broken by place, so that the order is the same everywhere.
  const auto stronger = [](const Candidate& a, const Candidate& b) {
    if (a.response != b.response) return a.response > b.response;
    return a.y != b.y ? a.y < b.y : a.x < b.x;
  };
  for (auto& cell : cells_) std::sort(cell.begin(), cell.end(), stronger);

  const auto wanted = static_cast<std::size_t>(config_.max_features);
  for (std::size_t rank = 0; corners.size() < wanted; ++rank) {
    rank_.clear();
    for (const auto& cell : cells_) {
      if (rank < cell.size()) rank_.push_back(cell[rank]);
    }
    if (rank_.empty()) break;
    std::sort(rank_.begin(), rank_.end(), stronger);
    if (rank_.size() > wanted - corners.size()) rank_.resize(wanted - corners.size());
    for (const Candidate& c : rank_) {
      corners.emplace_back(static_cast<float>(c.x), static_cast<float>(c.y));
    }
  }
}

}  // namespace rotrocc
