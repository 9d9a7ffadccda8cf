#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "common/workers.h"
#include "features/feature_detector.h"
#include "features/feature_tracker.h"
#include "features/keyframe.h"
#include "features/stereo_frame.h"
#include "features/stereo_matcher.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Makes the feature set F of section V-A of a keyframe (t-1 in the paper) and the current frame
/// (t): corners and their disparities in the keyframe, tracked from a predicted motion to the left
/// and the right current image, where they must match each other again. Keeps nothing from call to
/// call but its buffers.
class CorrespondenceFinder {
 public:
  using Config = CorrespondenceFinderConfig;

  /// Works with `threads`, the calling one included.
  explicit CorrespondenceFinder(const Config& config, int threads = 1);

  /// Copies the images of the pair into a frame, whose memory is reused when nobody holds it.
  FramePtr makeFrame(const StereoPair& pair);

  /// Finds the corners of the keyframe's left image ...
  void findCorners(Keyframe& keyframe);
  /// ... and triangulates those that have a match in its right image.
  void findDepths(const StereoCamera& camera, Keyframe& keyframe);

  /// Tracks the keyframe's points from where the motion puts them, which is a prediction or just a
  /// start, and keeps in `features` those that pass the circular consistency check: their left and
  /// right current positions match each other. Returns how many were tracked in both images.
  int find(const StereoCamera& camera,
           const Keyframe& keyframe,
           const StereoFrame& current,
           const Eigen::Isometry3d& T_keyframe_cur,
           bool is_prediction,
           Correspondences& features);

  /// How far flagged features of `current`, a sample of them, are lower in its right image [px].
  void compareRows(const StereoFrame& current,
                   const Correspondences& features,
                   const FeatureSet& set,
                   std::vector<float>& differences_px);

  /// Median distance [px] between where two motions put the keyframe's points in the current image;
  /// 0 if there are none.
  double medianShift(const StereoCamera& camera,
                     const Keyframe& keyframe,
                     const Eigen::Isometry3d& T_keyframe_cur_a,
                     const Eigen::Isometry3d& T_keyframe_cur_b);

 private:
  void predict(const StereoCamera& camera,
               const Keyframe& keyframe,
               const Eigen::Isometry3d& T_keyframe_cur);
  void track(const Keyframe& keyframe, const StereoFrame& current, bool is_prediction);
  void checkCircularConsistency(const StereoCamera& camera,
                                const Keyframe& keyframe,
                                const StereoFrame& current,
                                Correspondences& features);

  Config config_;
  Workers workers_;
  FeatureDetector detector_;
  StereoMatcher matcher_;
  FeatureTracker tracker_;
  FramePool frames_;

  // Of the keyframe's points; reused from call to call.
  std::vector<cv::Point2f> cur_left_px_, cur_right_px_;
  std::vector<float> predicted_disparities_px_;
  std::vector<float> scale_changes_;
  std::vector<char> tracked_;
  std::vector<float> tracked_disparities_px_, disparities_px_;
  std::vector<double> shifts_px_;
};

}  // namespace rotrocc
