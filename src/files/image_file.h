#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace rotrocc {

/// Reads an image file of any format of OpenCV as CV_8UC1. Colors are converted to gray, and those
/// with 16 bits are divided by 256. Throws std::runtime_error with the path if it is missing or
/// unreadable.
cv::Mat readGrayImage(const std::string& path);

/// The same, but CV_16UC1 if the file has 16 bits.
cv::Mat readGrayImageOfAnyDepth(const std::string& path);

/// The extension of the path is the format. Throws std::runtime_error with the path if it cannot.
void writeImage(const std::string& path, const cv::Mat& image);

/// Throws std::runtime_error with the path if an image that was read from it has another size.
/// `whose` has the size, as "the first image".
void requireImageSize(const std::string& path,
                      const cv::Mat& image,
                      const cv::Size& size,
                      const std::string& whose);

}  // namespace rotrocc
