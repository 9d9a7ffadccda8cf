#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "rotrocc/correspondence.h"
#include "rotrocc/feature_detector.h"
#include "rotrocc/feature_tracker.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_matcher.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Makes the feature set F of section V-A out of two stereo pairs: corners and their disparities at
/// t-1, tracked from a predicted motion to the left and the right image of t, where they must match
/// each other again. Keeps what it needs of the images; buffers are used again from pair to pair.
class CorrespondenceFinder {
 public:
  struct Config {
    FeatureDetector::Config feature_detector;
    StereoMatcher::Config stereo_matcher;
    FeatureTracker::Config feature_tracker;
  };

  explicit CorrespondenceFinder(const Config& config);

  /// The last pair becomes that of t-1 and `pair` that of t. The camera is that of both.
  void advance(const StereoPair& pair, const StereoCamera& camera);

  /// Finds the corners at t-1 and returns how many.
  int findCorners();
  /// Triangulates those that have a match in the right image of t-1, and returns how many.
  int findDepths();

  /// Tracks the triangulated corners from where the motion puts them, over `levels` of the
  /// pyramids, and returns how many were found in both images of t.
  int track(const Eigen::Isometry3d& T_prev_cur, int levels);
  /// Keeps, in `features`, those whose left and right positions at t match each other.
  void closeCircle(Correspondences& features);

  /// Median distance [px] between where two motions put the features at t.
  double medianShift(const Eigen::Isometry3d& T_prev_cur_a, const Eigen::Isometry3d& T_prev_cur_b);

 private:
  /// Level 0 of the pyramids are the images.
  struct StereoPyramid {
    FeatureTracker::Pyramid left, right;
  };

  Config config_;
  FeatureDetector detector_;
  StereoMatcher matcher_;
  FeatureTracker tracker_;
  StereoCamera camera_;
  StereoPyramid prev_, cur_;

  std::vector<cv::Point2f> corners_;
  std::vector<float> disparities_;
  std::vector<cv::Point2f> prev_left_, prev_right_;  // the triangulated corners ...
  std::vector<Eigen::Vector3d> prev_points_;         // ... and their places [m]
  std::vector<cv::Point2f> cur_left_, cur_right_;
  std::vector<char> tracked_;
  std::vector<float> expected_;
  std::vector<double> shifts_px_;
};

}  // namespace rotrocc
