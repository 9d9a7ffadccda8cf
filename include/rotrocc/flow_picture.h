#pragma once

#include <opencv2/core.hpp>

#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// The odometry's result for one pair. Both sets have one flag per feature.
struct FlowScene {
  const StereoPair& pair;  ///< the current one, of which the left image and its mask are drawn
  const StereoCamera& camera;
  const Correspondences& features;
  const FeatureSet& rotation_inliers;
  const FeatureSet& translation_inliers;
  const OdometryResult& result;
};

/// Draws the flow of each feature on the darkened left image, as a line from its position in the
/// keyframe to its current position. A line of text below the image gives the state, speed, feature
/// counts and disparity bias, and explains the colors. They are safe for color-blind readers.
/// What is masked is tinted red.
///
/// Inliers of both stages are colored by depth, from orange (near) to blue (far). Inliers of the
/// rotation stage only are white, all other features magenta. For these two, the flow that the
/// estimated motion predicts is drawn in green where it differs from the measured flow.
///
/// `picture` becomes CV_8UC3 in BGR order, as wide as the image and one text line higher. Its
/// buffer is reused. Throws cv::Exception if the image is empty or not CV_8UC1, or if a set does
/// not have one flag per feature.
void drawFlowPicture(const FlowScene& scene, cv::Mat& picture);

}  // namespace rotrocc
