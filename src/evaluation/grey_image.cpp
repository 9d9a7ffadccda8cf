#include "evaluation/grey_image.h"

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include <opencv2/imgcodecs.hpp>

#include "common/sentence.h"

namespace rotrocc {
namespace {

cv::Mat readImage(const std::string& path, int flags) {
  if (!std::filesystem::exists(path)) throw std::runtime_error(path + " is missing");
  cv::Mat image = cv::imread(path, flags);
  if (image.empty()) throw std::runtime_error(path + " is not a readable image");
  return image;
}

}  // namespace

cv::Mat readGreyImage(const std::string& path) {
  return readImage(path, cv::IMREAD_GRAYSCALE);
}

void requireImageSize(const std::string& path,
                      const cv::Mat& image,
                      const cv::Size& size,
                      const std::string& whose) {
  if (image.size() == size) return;
  throw std::runtime_error(sentence(path,
                                    " is ",
                                    image.cols,
                                    " x ",
                                    image.rows,
                                    " px, but ",
                                    whose,
                                    " is ",
                                    size.width,
                                    " x ",
                                    size.height,
                                    " px"));
}

cv::Mat GreyImageReader::read(const std::string& path) {
  const cv::Mat image = readImage(path, cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH);
  if (image.depth() != CV_16U) return image.depth() == CV_8U ? image : readGreyImage(path);
  double largest = 0.0;
  cv::minMaxLoc(image, nullptr, &largest);
  while (largest >= std::ldexp(1.0, significant_bits_)) ++significant_bits_;
  // Rounded down, as a shift is.
  const double scale = std::ldexp(1.0, 8 - significant_bits_);
  cv::Mat grey;
  image.convertTo(grey, CV_8U, scale, 0.5 * (scale - 1.0));
  return grey;
}

}  // namespace rotrocc
