#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// What a flow picture shows.
enum class FlowView {
  kMotion,    ///< the measured flow, coloured by depth and by stage
  kDecoupled  ///< the flow, split into rotation and translation
};

/// The names of the views: "motion", "decoupled".
const std::vector<std::string>& flowViewNames();

/// The view of that name. Throws std::invalid_argument on any other name.
FlowView flowView(const std::string& name);

/// The odometry's result for one pair. An empty set has no inliers.
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
/// counts and disparity bias, and explains the colours. They are safe for colour-blind readers.
/// What is masked is tinted red.
///
/// FlowView::kMotion: inliers of both stages are coloured by depth, from orange (near) to blue
/// (far). Inliers of the rotation stage only are white, all other features magenta. For these two,
/// the flow that the estimated motion predicts is drawn in green where it differs from the measured
/// flow.
///
/// FlowView::kDecoupled: the flow of each inlier in two parts, as in Fig. 2 of the paper. A blue
/// line goes from the current position to where the rotation maps it, an orange line from there to
/// where the translation maps it (Eq. 27, 28). Features that are not inliers of the rotation are
/// not drawn.
///
/// `picture` becomes CV_8UC3 in BGR order, as wide as the image and one text line higher. Its
/// buffer is reused. Throws std::invalid_argument if the image is empty or not CV_8UC1, or if a
/// non-empty set does not have one flag per feature.
void drawFlowPicture(const FlowScene& scene, FlowView view, cv::Mat& picture);

}  // namespace rotrocc
