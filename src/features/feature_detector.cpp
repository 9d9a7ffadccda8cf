#include "features/feature_detector.h"

#include <algorithm>
#include <cmath>

#include "common/image_grid.h"
#include "features/image_noise.h"
#include "kernels/kernels.h"

namespace rotrocc {
namespace {

constexpr int kRowStep = CornerResponse::kRowStep;

/// The response that a corner needs: four times that to the noise of the image. Fine texture looks
/// like noise, as that of gravel, so no more noise is assumed than cameras have in the dark: 4 gray
/// levels.
float minResponse(double noise_variance) {
  constexpr double kOverNoise = 4.0;
  constexpr double kMaxDeviation = 4.0;
  constexpr double kSobelSquares = 12.0 / 64.0;  // of a gradient in gray levels per pixel
  const double variance = std::min(noise_variance, kMaxDeviation * kMaxDeviation);
  return std::max(kMinTexture, static_cast<float>(kOverNoise * kSobelSquares * variance));
}

/// Steps of strength, 32 in each octave: the leading bits of a positive number.
int strengthOf(float response) {
  Cv32suf bits;
  bits.f = response;
  return bits.i >> 18;
}

/// Smallest distance between two corners, over the side of a feature's share of the image.
constexpr double kOfFeature = 0.3;

/// Whether no pixel within `radius_px` of (x, row) has a larger response, and none above or to the
/// left an equal one. Of equally strong corners, as in drawn patterns and saturated areas, the
/// first one counts. None in the rows from `row` to `below` is larger.
bool isFirstOfStrongest(const cv::Mat& response, int x, int row, int radius_px, int below) {
  const float value = response.at<float>(row, x);
  const auto isLess = [&](float other) { return other < value; };
  const auto isNotMore = [&](float other) { return other <= value; };
  const auto allIn = [&](int first_row, int end_row, const auto& holds) {
    for (int y = first_row; y < end_row; ++y) {
      const auto* center = response.ptr<float>(y) + x;
      if (!std::all_of(center - radius_px, center + radius_px + 1, holds)) return false;
    }
    return true;
  };
  const int rows = radius_px / kRowStep;
  const auto* here = response.ptr<float>(row) + x;
  return allIn(row - rows, row, isLess) && std::all_of(here - radius_px, here, isLess) &&
         allIn(below, row + rows + 1, isNotMore);
}

}  // namespace

void CornerResponse::compute(
    const cv::Mat& image, int first_row, int last_row, int margin, cv::Mat& response) {
  stride_ = static_cast<std::size_t>(image.cols + kSide);
  for (auto* row : {&smooth_, &steps_}) row->resize(stride_);
  for (auto* sums : {&xx_, &xy_, &yy_}) sums->assign(stride_, 0);
  gradients_.assign(static_cast<std::size_t>(2 * kSide) * stride_, 0);

  response.create(last_row - first_row, image.cols + 2 * margin + kMaxShorts, CV_32F);
  const int first = std::max(first_row, (kRadius_px + kRowStep - 1) / kRowStep);
  const int last = std::min(last_row, (image.rows - kRadius_px + kRowStep - 1) / kRowStep);
  const int count = image.cols - 2 * kRadius_px;
  if (first >= last || count <= 0) {
    response.setTo(0.0F);
    return;
  }
  const Kernels& kernels = chooseKernels();
  int next = kRowStep * first - kRadius_px;  // row of the image whose gradients are added next
  for (int r = first_row; r < last_row; ++r) {
    auto* out = response.ptr<float>(r - first_row);
    auto* end = out + response.cols;
    if (r < first || r >= last) {
      std::fill(out, end, 0.0F);
      continue;
    }
    for (; next <= kRowStep * r + kRadius_px; ++next) addGradients(image, next);
    auto* inner = std::fill_n(out, margin + kRadius_px, 0.0F);
    kernels.respondRow({xx_.data(), xy_.data(), yy_.data()}, count, inner);
    std::fill(inner + count, end, 0.0F);
  }
}

/// Adds the Sobel gradients of row y and removes those of the row kSide rows before. smooth_ and
/// steps_ start one pixel to the left of the image; pixels outside repeat the border.
void CornerResponse::addGradients(const cv::Mat& image, int y) {
  const Kernels& kernels = chooseKernels();
  std::int16_t* smooth = smooth_.data() + 1;
  std::int16_t* steps = steps_.data() + 1;
  kernels.differentiateRow(image.ptr<uchar>(std::max(y - 1, 0)),
                           image.ptr<uchar>(y),
                           image.ptr<uchar>(std::min(y + 1, image.rows - 1)),
                           image.cols,
                           smooth,
                           steps);
  for (std::int16_t* values : {smooth, steps}) {
    values[-1] = values[0];
    values[image.cols] = values[image.cols - 1];
  }
  std::int16_t* gradients = gradients_.data() + static_cast<std::size_t>(2 * (y % kSide)) * stride_;
  kernels.replaceGradients(smooth_.data(),
                           steps_.data(),
                           image.cols,
                           gradients,
                           gradients + stride_,
                           {xx_.data(), xy_.data(), yy_.data()});
}

FeatureDetector::FeatureDetector(const Config& config) : config_(config) {}

void FeatureDetector::detect(const cv::Mat& image,
                             std::vector<cv::Point2f>& corners,
                             int candidates,
                             const FeatureMask& mask) {
  corners.clear();
  if (std::min(image.cols, image.rows) <= 2 * (kBorder_px + kMaxRadius_px)) return;

  const double share_px2 = static_cast<double>(image.total()) / config_.max_features;
  radius_px_ = std::clamp(cvRound(kOfFeature * std::sqrt(share_px2)), kMinRadius_px, kMaxRadius_px);
  min_response_ = minResponse(noiseVariance(image));
  findCandidates(image, mask);
  sortByCells(image.size());
  const auto most = static_cast<std::size_t>(candidates * config_.max_features);
  candidates_.resize(std::min(most, candidates_.size()));
  for (const Candidate& c : candidates_) {
    corners.emplace_back(static_cast<float>(c.x), static_cast<float>(c.y));
  }
}

void FeatureDetector::findCandidates(const cv::Mat& image, const FeatureMask& mask) {
  candidates_.clear();
  const int margin = radius_px_ / kRowStep;
  const int first_row = (kBorder_px + kRowStep - 1) / kRowStep;
  const int last_row = (image.rows - kBorder_px + kRowStep - 1) / kRowStep;
  const int top = first_row - margin;
  corner_response_.compute(image, top, last_row + margin, radius_px_, response_);
  highest_.resize(static_cast<std::size_t>(response_.cols));
  for (int first = first_row; first < last_row; first += margin + 1) {
    searchBand(image.cols, {first, std::min(first + margin + 1, last_row)}, top, mask);
  }
}

/// Searches rows that are all within the radius of each other. A corner must be the maximum of
/// its column in these rows, and no neighboring column may have a larger one. Only these few
/// pixels are then compared with all their neighbors. The response begins with row `top`.
void FeatureDetector::searchBand(int width,
                                 const cv::Range& rows,
                                 int top,
                                 const FeatureMask& mask) {
  const int radius = radius_px_;
  const cv::Range band(rows.start - top, rows.end - top);
  float* highest = highest_.data();
  const Kernels& kernels = chooseKernels();
  kernels.highestOfColumns(response_.ptr<float>(band.start),
                           static_cast<std::ptrdiff_t>(response_.step1()),
                           band.size(),
                           width + 2 * radius,
                           highest);
  peaks_.resize(highest_.size());
  const int count = kernels.findPeaks(
      highest, kBorder_px, width - kBorder_px, radius, min_response_, peaks_.data());
  for (int i = 0; i < count; ++i) {
    const int x = peaks_[static_cast<std::size_t>(i)];
    const int column = x + radius;
    int row = band.start;
    while (response_.at<float>(row, column) != highest[column]) ++row;
    const int y = kRowStep * (top + row);
    if (isFirstOfStrongest(response_, column, row, radius, band.end) &&
        !mask.excludes(cv::Point(x, y))) {
      candidates_.push_back({highest[column], x, y, 0});
    }
  }
}

/// Sorts the candidates by their number in their cell, then by strength.
void FeatureDetector::sortByCells(const cv::Size& size) {
  float strongest = 0.0F;
  for (const Candidate& c : candidates_) strongest = std::max(strongest, c.response);
  for (Candidate& c : candidates_) c.rank = strengthOf(strongest) - strengthOf(c.response);
  sortByRank();
  const double side_px = std::sqrt(static_cast<double>(size.area()) / config_.max_features);
  const ImageGrid grid(
      size.width, size.height, cvCeil(size.width / side_px), cvCeil(size.height / side_px));
  cell_counts_.assign(grid.count(), 0);
  for (Candidate& c : candidates_) c.rank = cell_counts_[grid.cell(c.x, c.y)]++;
  sortByRank();
}

/// Equal ones keep their order.
void FeatureDetector::sortByRank() {
  for (const Candidate& c : candidates_) {
    const auto rank = static_cast<std::size_t>(c.rank);
    if (rank >= of_ranks_.size()) of_ranks_.resize(rank + 1);
    of_ranks_[rank].push_back(c);
  }
  candidates_.clear();
  for (auto& of_rank : of_ranks_) {
    candidates_.insert(candidates_.end(), of_rank.begin(), of_rank.end());
    of_rank.clear();
  }
}

}  // namespace rotrocc
