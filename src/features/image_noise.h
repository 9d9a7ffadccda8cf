#pragma once

#include <opencv2/core.hpp>

namespace rotrocc {

/// The smaller eigenvalue of the second moments of the gradients below which a window cannot be
/// located: (gray levels / px)^2. Six times what rounding to whole gray levels makes: its variance
/// of 1/12 gives Sobel and Scharr gradients one of 1/64.
constexpr float kMinTexture = 0.1F;

/// Variance of the noise of an image (CV_8UC1) in gray levels^2, at least that of rounding to whole
/// gray levels: from the median response to the mask of Immerkaer ("Fast Noise Variance
/// Estimation", 1996), which is zero where the image is a plane.
double noiseVariance(const cv::Mat& image);

/// Whether the gray levels of an image (CV_8UC1) hardly vary more than their noise, as behind a
/// covered lens.
bool isNoise(const cv::Mat& image);

}  // namespace rotrocc
