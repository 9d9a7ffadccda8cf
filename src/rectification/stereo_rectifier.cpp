#include "rectification/stereo_rectifier.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace rotrocc {
namespace {

/// Where a raw camera sees the pixel of a rectified image with the principal point (cx, camera.cy).
Eigen::Vector2d rawPixel(
    const RawCamera& raw, const StereoCamera& camera, double cx, int x, int y) {
  const Eigen::Vector3d rectified((x - cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0);
  Eigen::Vector3d ray = raw.R_rectified_raw.transpose() * rectified;
  // A camera that is turned far sees no ray from behind; the nearest is at its horizon.
  ray.z() = std::max(ray.z(), 1e-6 * ray.norm());
  return raw.project(ray);
}

void checkImage(const char* name, const cv::Mat& image, const cv::Size& size) {
  if (image.type() == CV_8UC1 && image.size() == size) return;
  throw std::invalid_argument(
      cv::format("the %s has %dx%d px, but its calibration", name, image.cols, image.rows) +
      cv::format(" is for %dx%d px grey images: use the calibration of this resolution",
                 size.width,
                 size.height));
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
        cv::format("the calibration of the %s camera: %s", name, error.what()));
  }
  Side side = {ImageResampler({raw.width, raw.height}, {camera.width, camera.height}),
               cv::Mat(camera.height, camera.width, CV_8UC1)};
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      side.resampler.setPlace(x, y, rawPixel(raw, camera, cx, x, y));
    }
  }
  return side;
}

void StereoRectifier::setCalibration(const StereoCalibration& calibration) {
  const StereoCamera& camera = calibration.rectified;
  Side left = makeSide("left", calibration.left, camera, camera.cx);
  right_ = makeSide("right", calibration.right, camera, camera.cx_right);
  left_ = std::move(left);  // after all that may throw: the sides are of one calibration
}

/// Once for each mask, into memory of its own: who has the last result may keep it.
const cv::Mat& StereoRectifier::rectifyMask(const char* name, const cv::Mat& raw_mask, Side& side) {
  if (raw_mask.data == side.raw_mask.data) return side.mask;
  if (!raw_mask.empty()) checkImage(name, raw_mask, side.resampler.source());
  side.raw_mask = raw_mask;
  side.mask.release();
  if (raw_mask.empty()) return side.mask;
  cv::Mat shares(side.rectified.size(), CV_8UC1);
  side.resampler.resample(raw_mask, shares);
  side.mask = shares > 0;
  return side.mask;
}

StereoPair StereoRectifier::rectify(const StereoPair& raw,
                                    const std::shared_ptr<const StereoCalibration>& calibration) {
  if (calibration != calibration_) setCalibration(*calibration);
  calibration_ = calibration;
  checkImage("left image", raw.left, left_->resampler.source());
  checkImage("right image", raw.right, right_->resampler.source());
  workers_.run(2, [&](int part) {
    Side& side = part == 0 ? *left_ : *right_;
    side.resampler.resample(part == 0 ? raw.left : raw.right, side.rectified);
  });
  return {raw.stamp_ns,
          left_->rectified,
          right_->rectified,
          rectifyMask("left mask", raw.left_mask, *left_),
          rectifyMask("right mask", raw.right_mask, *right_)};
}

}  // namespace rotrocc
