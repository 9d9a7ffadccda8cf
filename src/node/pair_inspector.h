#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "features/correspondence_finder.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// Looks for what a motion estimate cannot say of its cameras: that one is frozen, dark, exchanged
/// with the other, or that the images are not rectified.
class PairInspector {
 public:
  /// So many pairs in a row must look wrong.
  static constexpr int kPatience = 10;

  explicit PairInspector(const CorrespondenceFinder::Config& config);

  /// Another configuration from the next pair on. What was found with the one before is forgotten.
  void configure(const CorrespondenceFinder::Config& config);

  /// A sentence on what looks wrong, with what to do about it; empty if nothing does. Costs next to
  /// nothing, but some 50 ms when the kPatience-th pair in a row is lost or degraded.
  std::string inspect(const StereoPair& pair,
                      const StereoCamera& camera,
                      const OdometryResult& result);

 private:
  std::string findFrozen(const StereoPair& pair);
  std::string explainFewCorners(const StereoPair& pair) const;
  std::string explainLoss(const StereoPair& pair, const StereoCamera& camera);
  int countMatches(const cv::Mat& left, const cv::Mat& right, double infinity_px);

  Workers alone_{1};
  FeatureDetector detector_;
  StereoMatcher matcher_;
  std::vector<cv::Point2f> corners_;
  std::vector<float> disparities_;

  std::uint64_t left_print_ = 0, right_print_ = 0;  // of the last pair
  int left_frozen_ = 0, right_frozen_ = 0;          // pairs in a row
  int few_corners_ = 0, doubtful_ = 0;
  std::string explanation_;  // stays until the motion is found again
};

}  // namespace rotrocc
