#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace rotrocc {

/// All results of CorrespondenceFinder for two pairs of a camera of KITTI's size that moves forward
/// by `ahead_m`: the numbers of corners, depths and tracked features, and the values of the
/// features.
std::vector<double> runFrontEnd(const cv::Mat& prev_left,
                                const cv::Mat& prev_right,
                                const cv::Mat& cur_left,
                                const cv::Mat& cur_right,
                                double focal_px,
                                double ahead_m);

}  // namespace rotrocc
