#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "features/correspondence_finder.h"
#include "node/health/sliding_quantiles.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// Detects camera faults: a frozen or dark camera, swapped cameras, images that are not rectified,
/// or exposures that differ or move against each other so much that one of the images is likely to
/// be dark or saturated.
class PairInspector {
 public:
  /// Number of consecutive suspicious pairs before a hint.
  static constexpr int kPatience = 10;
  /// Number of pairs with a motion whose exposures are watched, and that suffice for a hint.
  static constexpr std::size_t kExposures = 50;
  static constexpr std::size_t kMinExposures = 10;

  /// `rectifies`: whether the images are rectified here, so that their calibration is to blame.
  explicit PairInspector(const CorrespondenceFinder::Config& config, bool rectifies = false);

  /// Uses another configuration from the next pair on, and forgets what was found with this one.
  void configure(const CorrespondenceFinder::Config& config);

  /// The suspected fault and a remedy, in one sentence; empty if none. Takes negligible time,
  /// except some 50 ms when the kPatience-th consecutive pair is lost or degraded.
  std::string inspect(const StereoPair& pair,
                      const StereoCamera& camera,
                      const OdometryResult& result);

 private:
  bool isNoise(const cv::Mat& image);
  std::string findFrozen(const StereoPair& pair);
  std::string compareExposures(const OdometryResult& result);
  std::string explainLoss(const StereoPair& pair, const StereoCamera& camera);
  int countMatches(const cv::Mat& left, const cv::Mat& right, double infinity_px);

  bool rectifies_;
  Workers alone_{1};
  FeatureDetector detector_;
  StereoMatcher matcher_;
  std::vector<cv::Point2f> corners_;
  std::vector<float> disparities_;

  std::uint64_t left_print_ = 0, right_print_ = 0;  // of the last pair
  int left_frozen_ = 0, right_frozen_ = 0;          // pairs in a row
  int few_corners_ = 0, doubtful_ = 0;
  SlidingQuantiles gains_{kExposures};
  std::string explanation_;  // kept until the motion is found again
  std::vector<int> noise_;   // buffer, reused
};

}  // namespace rotrocc
