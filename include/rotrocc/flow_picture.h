#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// What a flow picture shows.
enum class FlowView {
  kMotion,    ///< the measured flow, by depth and by stage
  kDecoupled  ///< the two parts of the flow: that of the rotation and that of the translation
};

/// "motion", "decoupled".
const std::vector<std::string>& flowViewNames();

/// Throws std::invalid_argument on another name.
FlowView flowView(const std::string& name);

/// What the odometry made of a pair. An empty set has no inliers.
struct FlowScene {
  const cv::Mat& left;  ///< CV_8UC1, the current image
  const StereoCamera& camera;
  const Correspondences& features;
  const FeatureSet& rotation_inliers;
  const FeatureSet& translation_inliers;
  const OdometryResult& result;
};

/// Draws the left image, darkened, and on it the flow of each feature, as lines that lead to its
/// current position from its position in the keyframe. A line of text below the image says
/// state, speed, counts and the rig's bias, and explains the colours, which colour-blind people can
/// tell apart, too.
///
/// FlowView::kMotion: inliers of both stages are coloured by depth, from orange (near) to blue
/// (far), inliers of the rotation stage alone are white, all other features magenta; where these
/// differ from the flow that the motion makes, that is drawn in green.
/// FlowView::kDecoupled: the flow of an inlier in its two parts, as in Fig. 2 of the paper: from
/// the current position to where the rotation takes it in blue, on from there to where the
/// translation takes it in orange (Eq. 27, 28). Features that are not inliers of the rotation are
/// left out.
///
/// `picture` becomes CV_8UC3 in BGR order, as wide as the image and a text line higher; its memory
/// is used again. Throws std::invalid_argument if `left` is no such image, or a set that is not
/// empty has not a flag for each feature.
void drawFlowPicture(const FlowScene& scene, FlowView view, cv::Mat& picture);

}  // namespace rotrocc
