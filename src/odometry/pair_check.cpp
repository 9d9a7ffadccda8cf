#include "odometry/pair_check.h"

#include <stdexcept>

#include "common/concatenate.h"
#include "common/to_seconds.h"

namespace rotrocc {
namespace {

std::string whyUnusable(const std::string& side, const cv::Mat& image, const StereoCamera& camera) {
  if (image.empty()) return "the " + side + " image is empty";
  if (image.type() != CV_8UC1) {
    return concatenate("the ", side, " image is of OpenCV type ", image.type(), ", not CV_8UC1");
  }
  if (image.cols == camera.width && image.rows == camera.height) return "";
  const std::string image_size = concatenate(image.cols, "x", image.rows);
  const std::string camera_size = concatenate(camera.width, "x", camera.height);
  return "the " + side + " image has " + image_size + " pixels, the camera " + camera_size;
}

}  // namespace

std::string whyUnusable(const StereoPair& pair,
                        const StereoCamera& camera,
                        const std::optional<std::int64_t>& newest_ns) {
  try {
    camera.check();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  const std::string left = whyUnusable("left", pair.left, camera);
  if (!left.empty()) return left;
  const std::string right = whyUnusable("right", pair.right, camera);
  if (!right.empty()) return right;
  if (!newest_ns || pair.stamp_ns > *newest_ns) return "";
  return concatenate("the stamp ",
                     pair.stamp_ns,
                     " ns is not later than that of the pair before, ",
                     *newest_ns,
                     " ns");
}

std::string whyRestart(const StereoPair& pair,
                       const StereoCamera& camera,
                       const std::optional<std::int64_t>& newest_ns,
                       const StereoCamera& camera_before,
                       double max_gap_s) {
  if (!newest_ns) return "first pair";
  if (camera != camera_before) return "the camera has changed";
  const double gap_s = toSeconds(pair.stamp_ns - *newest_ns);
  if (gap_s <= max_gap_s) return "";
  return concatenate("no pair for ", gap_s, " s, more than max_gap_s = ", max_gap_s);
}

}  // namespace rotrocc
