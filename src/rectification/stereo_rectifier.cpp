#include "rectification/stereo_rectifier.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <opencv2/imgproc.hpp>

#include "common/sentence.h"

namespace rotrocc {
namespace {

/// Where a raw camera sees the pixel of a rectified image with the principal point (cx, camera.cy).
Eigen::Vector2d rawPixel(
    const RawCamera& raw, const StereoCamera& camera, double cx, int x, int y) {
  const Eigen::Vector3d rectified((x - cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0);
  Eigen::Vector3d ray = raw.R_rectified_raw.transpose() * rectified;
  // A camera that is turned far sees no ray from behind; the nearest is at its horizon.
  ray.z() = std::max(ray.z(), 1e-6 * ray.norm());
  const Eigen::Vector2d pixel = raw.project(ray);
  // The maps of OpenCV have 16 bits. !(a < b) is true for NaN.
  constexpr double kFar_px = 32000.0;
  if (!(pixel.cwiseAbs().maxCoeff() < kFar_px)) return {-1.0, -1.0};
  return pixel;
}

void checkImage(const char* side, const cv::Mat& image, const cv::Size& size) {
  if (image.type() == CV_8UC1 && image.size() == size) return;
  throw std::invalid_argument(sentence("the ",
                                       side,
                                       " image has ",
                                       image.cols,
                                       "x",
                                       image.rows,
                                       " px, but its calibration is for ",
                                       size.width,
                                       "x",
                                       size.height,
                                       " px grey images: use the calibration of this resolution"));
}

}  // namespace

StereoRectifier::Side StereoRectifier::makeSide(const char* name,
                                                const RawCamera& raw,
                                                const StereoCamera& camera,
                                                double cx) {
  try {
    raw.check();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        sentence("the calibration of the ", name, " camera: ", error.what()));
  }
  cv::Mat places(camera.height, camera.width, CV_32FC2);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector2f place = rawPixel(raw, camera, cx, x, y).cast<float>();
      places.at<cv::Vec2f>(y, x) = {place.x(), place.y()};
    }
  }
  Side side;
  side.raw_size = {raw.width, raw.height};
  cv::convertMaps(places, cv::noArray(), side.map, side.fractions, CV_16SC2);
  side.rectified.create(places.size(), CV_8UC1);
  return side;
}

StereoRectifier::StereoRectifier(const StereoCalibration& calibration)
    : camera_(calibration.rectified),
      left_(makeSide("left", calibration.left, camera_, camera_.cx)),
      right_(makeSide("right", calibration.right, camera_, camera_.cx_right)) {}

StereoPair StereoRectifier::rectify(const StereoPair& raw) {
  checkImage("left", raw.left, left_.raw_size);
  checkImage("right", raw.right, right_.raw_size);
  workers_.run(2, [&](int part) {
    Side& side = part == 0 ? left_ : right_;
    cv::remap(part == 0 ? raw.left : raw.right,
              side.rectified,
              side.map,
              side.fractions,
              cv::INTER_LINEAR,
              cv::BORDER_REPLICATE);
  });
  return {raw.stamp_ns, left_.rectified, right_.rectified};
}

}  // namespace rotrocc
