#pragma once

#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

#include "common/workers.h"
#include "features/corner_response.h"
#include "features/feature_mask.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

/// Shi-Tomasi corners (Shi and Tomasi, CVPR 1994), distributed over the image by a grid.
class FeatureDetector {
 public:
  using Config = FeatureDetectorConfig;

  /// Smallest distance between two corners, in x or y: windows of the tracker overlap by half.
  static constexpr int kRadius_px = 5;
  /// No corners are closer to the border of the image: windows of the matcher fit in.
  static constexpr int kBorder_px = 8;

  explicit FeatureDetector(const Config& config);

  /// Finds at most max_features times `candidates` corners of `image` (CV_8UC1), at integer pixels
  /// that the mask does not exclude. The image has about max_features cells. The strongest corners
  /// of all cells come first, then the second strongest of all cells, and so on. Returns none if
  /// the image is too small.
  void detect(Workers& workers,
              const cv::Mat& image,
              std::vector<cv::Point2f>& corners,
              int candidates = 1,
              const FeatureMask& mask = {});

 private:
  struct Candidate {
    float response;
    int x, y;
    int rank;  ///< number of stronger ones in its cell
  };
  /// Rows that are searched by one thread.
  struct Strip {
    CornerResponse corner_response;
    cv::Mat response;            // includes a margin around the strip
    std::vector<float> highest;  // maximum of each column
    std::vector<int> peaks;      // local maxima of `highest`
    std::vector<Candidate> candidates;
  };

  void findCandidates(const cv::Mat& image, int first_row, int last_row, Strip& strip) const;
  void searchBand(int width, const cv::Range& rows, int top, Strip& strip) const;
  void selectByCells(const cv::Size& size,
                     std::size_t max_count,
                     std::vector<cv::Point2f>& corners);
  void collectCandidates(const FeatureMask& mask);
  void rankByCells(const cv::Size& size);

  Config config_;
  std::vector<Strip> strips_;
  std::vector<Candidate> candidates_;
  std::vector<int> cell_counts_;
  std::vector<int> noise_;  // responses to a mask
  float min_response_ = 0.0F;
};

}  // namespace rotrocc
