#pragma once

#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>

#include "features/stereo_frame.h"
#include "features/stereo_matcher.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Finds correspondences without a prediction, anywhere in the image: oriented binary descriptors
/// (ORB, Rublee et al. 2011) that are each other's nearest neighbor. They are exact to a pixel or
/// two, and many are wrong. It takes about 10 ms.
class DescriptorMatcher {
 public:
  explicit DescriptorMatcher(const StereoMatcherConfig& config);

  /// What is seen in the left images of both frames and has a depth in the current one. Points of
  /// the current frame are `row_offset_px` lower in the right image.
  Correspondences match(const StereoCamera& camera,
                        const StereoFrame& earlier,
                        const StereoFrame& current,
                        double row_offset_px);

 private:
  struct Described {
    std::vector<cv::KeyPoint> keypoints;
    cv::Mat descriptors;
  };
  Described describe(const cv::Mat& image, const FeatureMask& mask);

  StereoMatcher matcher_;
  cv::Ptr<cv::ORB> orb_;
  cv::BFMatcher nearest_;
};

}  // namespace rotrocc
