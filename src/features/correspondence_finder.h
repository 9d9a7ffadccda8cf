#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "common/workers.h"
#include "features/feature_detector.h"
#include "features/feature_tracker.h"
#include "features/stereo_matcher.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Makes the feature set F of section V-A out of two stereo pairs, a keyframe (t-1 in the paper)
/// and the current one (t): corners and their disparities at the keyframe, tracked from a
/// predicted motion to the left and the right current image, where they must match each other
/// again. Keeps what it needs of the images; buffers are used again from pair to pair.
class CorrespondenceFinder {
 public:
  using Config = CorrespondenceFinderConfig;

  /// Works with so many `threads`, the calling one included.
  explicit CorrespondenceFinder(const Config& config, int threads = 1);

  /// Takes other parameters, and keeps the last pair and that set aside.
  void configure(const Config& config, int threads);

  /// Makes `pair` the current one; the one before is dropped unless it was kept.
  void take(const StereoPair& pair, const StereoCamera& camera);
  /// Keeps the current pair as the last one.
  void keep();
  /// Keeps the current pair aside, in case the last one proves to be of no use ...
  void setAside();
  /// ... and makes the pair set aside the last one.
  void takeUpAside();
  /// Makes the last pair the keyframe.
  void refer();

  /// Finds the corners of the keyframe and returns how many.
  int findCorners();
  /// Triangulates those that have a match in its right image, and returns how many.
  int findDepths();

  /// Tracks the triangulated corners from where the motion puts them, which is a prediction or just
  /// a place to begin, and returns how many were found in both current images.
  int track(const Eigen::Isometry3d& T_keyframe_cur, bool is_prediction);
  /// Keeps, in `features`, those whose left and right current positions match each other.
  void checkCircularConsistency(Correspondences& features);

  /// How far flagged features, a sample of those of checkCircularConsistency(), are lower in the
  /// right image [px].
  void compareRows(const Correspondences& features,
                   const FeatureSet& set,
                   std::vector<float>& differences_px);

  /// Median distance [px] between where two motions put the features in the current image.
  double medianShift(const Eigen::Isometry3d& T_keyframe_cur_a,
                     const Eigen::Isometry3d& T_keyframe_cur_b);

 private:
  /// Level 0 of the pyramids are the images.
  struct StereoPyramid {
    FeatureTracker::Pyramid left, right;
  };

  Config config_;
  Workers workers_;
  FeatureDetector detector_;
  StereoMatcher matcher_;
  FeatureTracker tracker_;
  StereoCamera camera_;
  std::array<StereoPyramid, 4> pyramids_;
  std::size_t reference_ = 0;  // of pyramids_, as those below; all may be the same
  std::size_t last_ = 0;
  std::size_t aside_ = 0;
  std::size_t current_ = 0;

  std::vector<cv::Point2f> corners_;
  std::vector<float> disparities_;
  std::vector<cv::Point2f> ref_left_, ref_right_;  // the triangulated corners ...
  std::vector<Eigen::Vector3d> ref_points_;        // ... and their places [m]
  std::vector<cv::Point2f> cur_left_, cur_right_;
  std::vector<float> growth_;  // of what is seen, by coming nearer
  std::vector<char> tracked_;
  std::vector<float> expected_;
  std::vector<double> shifts_px_;
};

}  // namespace rotrocc
