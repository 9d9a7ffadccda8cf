#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace rotrocc {

/// Image formats other than PNG, by imgcodecs of OpenCV. It brings GDAL and more than 100 other
/// libraries, so it is loaded when it is first needed, with the library rotrocc_image_codecs.

/// Reads an image as CV_8UC1 or CV_16UC1; empty if it is not readable. Throws std::runtime_error if
/// imgcodecs cannot be loaded.
cv::Mat readGreyByOpenCv(const std::string& path);

/// An image as a file of the format that `extension` names, as ".tiff".
std::vector<unsigned char> encodeByOpenCv(const std::string& extension, const cv::Mat& image);

}  // namespace rotrocc
