#pragma once

#include <opencv2/core.hpp>

#include "rotrocc/correspondence.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// Draws what the odometry saw in a pair: the left image, darkened, and on it the flow of each
/// feature as a line from its previous to its current position. Inliers of both stages are coloured
/// by depth, from orange (near) to blue (far), inliers of the rotation stage alone are white, all
/// other features magenta: colours that also colour-blind people can tell apart. A line of text
/// below the image says state, speed and counts and explains the colours.
///
/// `left` is CV_8UC1. `picture` becomes CV_8UC3 in BGR order, as wide as the image and a text line
/// higher; its memory is used again. An empty set has no inliers. Throws std::invalid_argument if
/// `left` is no such image, or a set that is not empty has not a flag for each feature.
void drawFlowPicture(const cv::Mat& left,
                     const Correspondences& features,
                     const FeatureSet& rotation_inliers,
                     const FeatureSet& translation_inliers,
                     const OdometryResult& result,
                     cv::Mat& picture);

}  // namespace rotrocc
