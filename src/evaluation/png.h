#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace rotrocc {

/// Whether a file begins as a PNG does.
bool isPng(const std::string& path);

/// Reads a PNG as CV_16UC1 if it has 16 bits, otherwise as CV_8UC1: the pixels of cv::imread() with
/// IMREAD_GRAYSCALE | IMREAD_ANYDEPTH. Colours are weighted by 0.299, 0.587 and 0.114, transparency
/// is ignored. Throws std::runtime_error with the path and the cause if it cannot.
cv::Mat readGreyPng(const std::string& path);

/// A PNG, compressed for speed, of an image of 8 or 16 bits that is grey or blue, green and red.
std::vector<unsigned char> encodePng(const cv::Mat& image);

/// Throws std::runtime_error with the path if it cannot.
void writePng(const std::string& path, const cv::Mat& image);

}  // namespace rotrocc
