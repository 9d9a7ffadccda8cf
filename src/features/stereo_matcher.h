#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include <opencv2/core.hpp>

#include "common/workers.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

struct Kernels;

/// Sparse block matching along the row: sum of absolute differences (SAD) with a sub-pixel fit.
class StereoMatcher {
 public:
  using Config = StereoMatcherConfig;

  /// Disparity of a pixel without a match.
  static constexpr float kNoDisparity = std::numeric_limits<float>::lowest();

  /// How far from what is expected matchNear() looks.
  static constexpr int kNearRadius_px = 2;

  explicit StereoMatcher(const Config& config);

  /// Disparity x_left - x_right [px] of each corner of the left image, which are at whole pixels,
  /// or kNoDisparity: too near to the edge, too different, ambiguous, or outside of the range.
  /// `left` and `right` are CV_8UC1 of one size; `infinity_px` is
  /// StereoCamera::disparityAtInfinity().
  void match(Workers& workers,
             const cv::Mat& left,
             const cv::Mat& right,
             const std::vector<cv::Point2f>& corners,
             double infinity_px,
             std::vector<float>& disparities_px) const;

  /// The same, but for pixels anywhere, within kNearRadius_px of the `expected_px` disparities, and
  /// asks for no uniqueness, which the expectation gives. Pixels whose expectation is kNoDisparity
  /// are skipped.
  void matchNear(Workers& workers,
                 const cv::Mat& left,
                 const cv::Mat& right,
                 const std::vector<cv::Point2f>& pixels,
                 const std::vector<float>& expected_px,
                 double infinity_px,
                 std::vector<float>& disparities_px) const;

 private:
  Config config_;
  const Kernels* kernels_;
};

}  // namespace rotrocc
