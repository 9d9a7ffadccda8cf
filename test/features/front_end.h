#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace rotrocc {

/// All that CorrespondenceFinder finds in two pairs, of a camera of the size of KITTI's that moves
/// ahead by `ahead_m`: the counts of corners, depths and tracked features, and the features'
/// numbers.
std::vector<double> runFrontEnd(const cv::Mat& prev_left,
                                const cv::Mat& prev_right,
                                const cv::Mat& cur_left,
                                const cv::Mat& cur_right,
                                double focal_px,
                                double ahead_m);

}  // namespace rotrocc
