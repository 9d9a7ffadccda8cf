#pragma once

#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

#include "check/checked_pair.h"
#include "check/image_grid.h"
#include "check/rig_report.h"
#include "features/feature_detector.h"
#include "features/stereo_matcher.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

/// What the cameras see: where there are corners, which of them have a disparity and why others do
/// not, how far away they are, and where features never agree with the motion.
class ViewCheck {
 public:
  explicit ViewCheck(const OdometryConfig& config);

  void observe(const CheckedPair& pair);

  /// Adds the section view, its tables, and a mask if one is proposed.
  void report(RigReport& report) const;

 private:
  struct Cell {
    int corners = 0, with_depth = 0;
    int features = 0, inliers = 0;
    int still = 0;  ///< pairs in which it stays as it is, while others change
  };

  /// Why corners have no disparity.
  struct Missing {
    int too_near = 0, beyond_infinity = 0, other_row = 0, outside = 0, ambiguous = 0;
  };

  void compareWithLast(const CheckedPair& pair, const ImageGrid& fine);
  void countCorners(const CheckedPair& pair);
  void explain(const CheckedPair& pair, const std::vector<cv::Point2f>& without_disparity);
  void addDisparities(RigReport& report) const;
  void addCoverage(RigReport& report) const;
  void addDepths(RigReport& report) const;
  void addMask(RigReport& report) const;
  cv::Mat disagreeing() const;

  StereoMatcherConfig config_;
  Workers workers_;
  FeatureDetector detector_;
  StereoCamera camera_;
  std::vector<Cell> map_, fine_map_;  // of ImageGrid and of twice as many columns
  Missing missing_;
  cv::Mat last_;                                // left image
  int changing_pairs_ = 0, resting_pairs_ = 0;  // whose images change; of these, without a motion
  int pairs_ = 0;
  int corners_ = 0, with_depth_ = 0;
  std::vector<double> depths_m_;
};

}  // namespace rotrocc
