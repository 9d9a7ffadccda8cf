#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "features/stereo_frame.h"
#include "kernels/image_kernels.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

/// The corner response of the pixels of each second row: the smaller eigenvalue of the second
/// moments of the gradients (Shi and Tomasi, CVPR 1994), averaged over a square, in (gray levels /
/// px)^2. Row r of the response is that of row kRowStep r of the image; between two rows, it hardly
/// changes. Sums are exact, so the response of a pixel does not depend on which rows are requested.
class CornerResponse {
 public:
  static constexpr int kRowStep = 2;
  /// The square has a side of 2 radius + 1 pixels.
  static constexpr int kRadius_px = ColumnSums::kSide / 2;

  /// Fills `response` (CV_32F) with its rows [first_row, last_row) for `image` (CV_8UC1) and
  /// `margin` columns of zeros on both sides. Rows may lie outside the image. The response is zero
  /// there, and where the square would leave the image.
  void compute(const cv::Mat& image, int first_row, int last_row, int margin, cv::Mat& response);

 private:
  void addGradients(const cv::Mat& image, int y);

  static constexpr int kSide = ColumnSums::kSide;

  std::size_t stride_ = 0;  // row length of the buffers below: image width plus a margin
  std::vector<std::int16_t> smooth_, steps_;  // one row, smoothed, differentiated vertically
  std::vector<std::int16_t> gradients_;       // gradients of the last kSide rows (ring)
  std::vector<std::int32_t> xx_, xy_, yy_;    // products of gradients, summed over those rows
};

/// Shi-Tomasi corners (Shi and Tomasi, CVPR 1994), distributed over the image by a grid.
class FeatureDetector {
 public:
  using Config = FeatureDetectorConfig;

  /// Smallest distance between two corners, in x or y: windows of the tracker overlap by half. In
  /// an image with too few such places, it is less, down to the size of a corner.
  static constexpr int kMaxRadius_px = 5;
  static constexpr int kMinRadius_px = 3;
  /// No corners are closer to the border of the image: windows of the matcher fit in.
  static constexpr int kBorder_px = 8;

  explicit FeatureDetector(const Config& config);

  /// Finds at most max_features times `candidates` corners of `image` (CV_8UC1), at integer pixels
  /// that the mask does not exclude. The image has about max_features cells. The strongest corners
  /// of all cells come first, then the second strongest of all cells, and so on. Returns none if
  /// the image is too small.
  void detect(const cv::Mat& image,
              std::vector<cv::Point2f>& corners,
              int candidates = 1,
              const FeatureMask& mask = {});

 private:
  struct Candidate {
    float response;
    int x, y;
    int rank;  ///< key of the order: steps from the strongest, then stronger ones in its cell
  };

  void findCandidates(const cv::Mat& image, const FeatureMask& mask);
  void searchBand(int width, const cv::Range& rows, int top, const FeatureMask& mask);
  void sortByCells(const cv::Size& size);
  void sortByRank();

  Config config_;
  CornerResponse corner_response_;
  cv::Mat response_;            // with a margin around it
  std::vector<float> highest_;  // maximum of each column
  std::vector<int> peaks_;      // local maxima of `highest_`
  std::vector<Candidate> candidates_;
  std::vector<std::vector<Candidate>> of_ranks_;
  std::vector<int> cell_counts_;
  float min_response_ = 0.0F;
  int radius_px_ = kMaxRadius_px;
};

}  // namespace rotrocc
