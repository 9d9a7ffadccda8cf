#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "features/feature_detector.h"
#include "features/feature_tracker.h"
#include "features/stereo_frame.h"
#include "features/stereo_matcher.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Builds the feature set F of section V-A from a keyframe (t-1 in the paper) and the current frame
/// (t). Corners and disparities of the keyframe are tracked to the left and right current images,
/// starting at the positions that a motion predicts, and are verified by the circular consistency
/// check. Has no state except reused buffers and the gain between the last images.
class CorrespondenceFinder {
 public:
  using Config = CorrespondenceFinderConfig;

  explicit CorrespondenceFinder(const Config& config);
  virtual ~CorrespondenceFinder() = default;

  /// Copies the images of the pair into a frame, to be used at a level of its pyramids: not before
  /// they are halved if only smaller ones are used. Frames that are no longer referenced are
  /// reused.
  FramePtr makeFrame(const StereoPair& pair, int level = 0);

  /// Finds the corners of the keyframe's left image, more than are wanted: some have no match.
  virtual void findCorners(Keyframe& keyframe);
  /// Matches the corners in the keyframe's right image, in their order, until as many as wanted
  /// have a depth, and triangulates these. Removes the corners that were not needed.
  virtual void findDepths(const StereoCamera& camera, int wanted, Keyframe& keyframe);

  /// Tracks the keyframe's points, starting at the positions given by the motion. Stores in
  /// `features` those that pass the circular consistency check: their current left and right
  /// positions match each other. Returns the number of points tracked in both images.
  virtual int find(const StereoCamera& camera,
                   const Keyframe& keyframe,
                   const StereoFrame& current,
                   const Eigen::Isometry3d& T_keyframe_cur,
                   Correspondences& features);

  /// Contrast of the right image relative to the left one, at the features found last; 1 before.
  double stereoGain() const { return stereo_gain_; }

  /// Median distance [px] between the positions of the keyframe's points in the current image for
  /// two motions. 0 if there are no points.
  double medianShift(const StereoCamera& camera,
                     const Keyframe& keyframe,
                     const Eigen::Isometry3d& T_keyframe_cur_a,
                     const Eigen::Isometry3d& T_keyframe_cur_b);

 protected:
  const Config& config() const { return config_; }

 private:
  std::shared_ptr<StereoFrame> unusedFrame();
  void addPoint(const RectifiedImages& images, const cv::Point2f& corner, Keyframe& keyframe) const;

  struct Tracked {
    cv::Point2f left, right;  ///< in the current images
  };
  std::optional<Tracked> track(const StereoCamera& camera,
                               const Keyframe& keyframe,
                               const StereoFrame& current,
                               const Eigen::Isometry3d& T_cur_keyframe,
                               std::size_t i);
  std::optional<float> consistentDisparity(const RectifiedImages& images,
                                           const StereoFrame& current,
                                           const Tracked& tracked,
                                           const cv::Point2f& late_px);

  Config config_;
  FeatureDetector detector_;
  StereoMatcher matcher_;
  FeatureTracker tracker_;
  std::vector<std::shared_ptr<StereoFrame>> frames_;
  FeatureMask left_mask_, right_mask_;  // of the latest frame

  std::vector<float> gains_;       // of the matches, reused
  std::vector<double> shifts_px_;  // reused
  double stereo_gain_ = 1.0;       // from left to right, at the features found last
};

}  // namespace rotrocc
