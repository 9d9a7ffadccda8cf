#include "odometry/pair_check.h"

#include "common/sentence.h"

namespace rotrocc {
namespace {

std::string whyUnusable(const std::string& side, const cv::Mat& image, const StereoCamera& camera) {
  if (image.empty()) return "the " + side + " image is empty";
  if (image.type() != CV_8UC1) {
    return sentence("the ", side, " image is of OpenCV type ", image.type(), ", not CV_8UC1");
  }
  if (image.cols == camera.width && image.rows == camera.height) return "";
  const std::string image_size = sentence(image.cols, "x", image.rows);
  const std::string camera_size = sentence(camera.width, "x", camera.height);
  return "the " + side + " image has " + image_size + " pixels, the camera " + camera_size;
}

}  // namespace

std::string whyUnusable(const StereoPair& pair, const StereoCamera& camera) {
  const std::string left = whyUnusable("left", pair.left, camera);
  return left.empty() ? whyUnusable("right", pair.right, camera) : left;
}

}  // namespace rotrocc
