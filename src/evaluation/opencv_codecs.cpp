#include "evaluation/opencv_codecs.h"

#include <opencv2/imgcodecs.hpp>

namespace rotrocc {
namespace {

cv::Mat readGrey(const std::string& path) {
  const cv::Mat image = cv::imread(path, cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH);
  const bool is_integer = image.depth() == CV_8U || image.depth() == CV_16U;
  return is_integer ? image : cv::imread(path, cv::IMREAD_GRAYSCALE);
}

std::vector<unsigned char> encode(const std::string& extension, const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  cv::imencode(extension, image, bytes);
  return bytes;
}

}  // namespace
}  // namespace rotrocc

const rotrocc::OpenCvCodecs rotrocc_image_codecs = {rotrocc::readGrey, rotrocc::encode};
