#include "files/image_file.h"

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include <opencv2/imgcodecs.hpp>

namespace rotrocc {

cv::Mat readGrayImageOfAnyDepth(const std::string& path) {
  if (!std::filesystem::exists(path)) throw std::runtime_error(path + " is missing");
  cv::Mat image;
  try {
    image = cv::imread(path, cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH);
    const bool is_integer = image.depth() == CV_8U || image.depth() == CV_16U;
    if (!is_integer) image = cv::imread(path, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {  // too many pixels
    image.release();
  }
  if (!image.empty()) return image;
  throw std::runtime_error(path +
                           " is not a readable image: is it damaged, or no image? Copy it again");
}

cv::Mat readGrayImage(const std::string& path) {
  cv::Mat image = readGrayImageOfAnyDepth(path);
  if (image.depth() == CV_8U) return image;
  const double scale = std::ldexp(1.0, -8);
  image.convertTo(image, CV_8U, scale, 0.5 * (scale - 1.0));  // rounded down, as a shift is
  return image;
}

void writeImage(const std::string& path, const cv::Mat& image) {
  if (cv::imwrite(path, image)) return;
  throw std::runtime_error("cannot write " + path + ": is the disk full?");
}

void requireImageSize(const std::string& path,
                      const cv::Mat& image,
                      const cv::Size& size,
                      const std::string& whose) {
  if (image.size() == size) return;
  const auto text = [](const cv::Size& s) { return cv::format("%d x %d px", s.width, s.height); };
  throw std::runtime_error(path + " is " + text(image.size()) + ", but " + whose + " is " +
                           text(size));
}

}  // namespace rotrocc
