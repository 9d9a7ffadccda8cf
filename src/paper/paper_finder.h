#pragma once

#include "features/correspondence_finder.h"

namespace rotrocc {

/// The feature set F of section V-A as published, from the standard functions of OpenCV that the
/// paper names: corners by Shi and Tomasi, disparities by block matching with the sum of absolute
/// differences, optical flow by Lucas and Kanade. Simple rather than fast.
class PaperFinder : public CorrespondenceFinder {
 public:
  using CorrespondenceFinder::CorrespondenceFinder;

  /// The `max_features` strongest corners. None is replaced if it has no disparity.
  void findCorners(Keyframe& keyframe) override;
  void findDepths(const StereoCamera& camera, int wanted, Keyframe& keyframe) override;
  int find(const StereoCamera& camera,
           const Keyframe& keyframe,
           const StereoFrame& current,
           const Eigen::Isometry3d& T_keyframe_cur,
           Correspondences& features) override;

 private:
  cv::Mat matchBlocks(const StereoCamera& camera, const StereoFrame& frame) const;
  bool isUsable(const StereoCamera& camera, double disparity_px) const;
  std::vector<uchar> track(const cv::Mat& from,
                           const cv::Mat& to,
                           const std::vector<cv::Point2f>& from_px,
                           std::vector<cv::Point2f>& to_px) const;
};

}  // namespace rotrocc
