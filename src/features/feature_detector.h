#pragma once

#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

#include "common/workers.h"
#include "features/corner_response.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

struct Kernels;

/// Shi-Tomasi corners (Shi and Tomasi, CVPR 1994), distributed over the image by a grid.
class FeatureDetector {
 public:
  using Config = FeatureDetectorConfig;

  explicit FeatureDetector(const Config& config);

  /// Finds at most max_features corners of `image` (CV_8UC1), at integer pixels. The strongest
  /// corners of all cells come first, then the second strongest of all cells, and so on. Returns
  /// none if the image is too small.
  void detect(Workers& workers, const cv::Mat& image, std::vector<cv::Point2f>& corners);

 private:
  struct Candidate {
    float response;
    int x, y;
  };
  /// Rows that are searched by one thread.
  struct Strip {
    explicit Strip(int block_radius_px) : corner_response(block_radius_px) {}

    CornerResponse corner_response;
    cv::Mat response;            // includes a margin of nms_radius_px around the strip
    std::vector<float> highest;  // maximum of each column
    std::vector<int> peaks;      // local maxima of `highest`
    std::vector<Candidate> candidates;
  };

  void findCandidates(const cv::Mat& image, int first_row, int last_row, Strip& strip) const;
  void searchBand(int width, const cv::Range& rows, int top, Strip& strip) const;
  void selectByCells(const cv::Size& size, std::vector<cv::Point2f>& corners);
  void sortByCells(const cv::Size& size);
  static bool isStronger(const Candidate& a, const Candidate& b);

  Config config_;
  const Kernels* kernels_;
  std::vector<Strip> strips_;
  std::vector<std::size_t> cell_ends_;  // end of each cell in by_cell_
  std::vector<Candidate> by_cell_;
  std::vector<Candidate> rank_;
};

}  // namespace rotrocc
