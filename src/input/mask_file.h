#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace rotrocc {

/// Reads a PNG file as CV_8UC1: 255 where it is not black, 0 elsewhere. Transparent pixels are
/// black. Throws std::runtime_error with the path and the problem if it cannot be read.
cv::Mat readMask(const std::string& path);

/// `path` with its first "%s" replaced by `side`.
std::string pathOfSide(std::string path, const std::string& side);

}  // namespace rotrocc
