#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace rotrocc {

/// Variance of the noise of an image (CV_8UC1) in grey levels^2, at least that of rounding to whole
/// grey levels: from the median response to the mask of Immerkaer ("Fast Noise Variance
/// Estimation", 1996), which is zero where the image is a plane. `responses` is a buffer.
double noiseVariance(const cv::Mat& image, std::vector<int>& responses);

}  // namespace rotrocc
