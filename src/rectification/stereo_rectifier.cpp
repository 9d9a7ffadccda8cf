#include "rectification/stereo_rectifier.h"

#include <algorithm>
#include <vector>

namespace rotrocc {
namespace {

/// Where a raw camera sees a row of a rectified image with the principal point (cx, camera.cy).
std::vector<cv::Point2d> rawPixels(const RawCamera& raw,
                                   const StereoCamera& camera,
                                   double cx,
                                   int y) {
  std::vector<Eigen::Vector3d> rays;
  for (int x = 0; x < camera.width; ++x) {
    const Eigen::Vector3d rectified((x - cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0);
    Eigen::Vector3d& ray = rays.emplace_back(raw.R_rectified_raw.transpose() * rectified);
    // A camera that is turned far sees no ray from behind; the nearest is at its horizon.
    ray.z() = std::max(ray.z(), 1e-6 * ray.norm());
  }
  return raw.project(rays);
}

}  // namespace

StereoRectifier::Side StereoRectifier::makeSide(const RawCamera& raw,
                                                const StereoCamera& camera,
                                                double cx) {
  Side side = {ImageResampler({raw.width, raw.height}, {camera.width, camera.height}),
               cv::Mat(camera.height, camera.width, CV_8UC1)};
  for (int y = 0; y < camera.height; ++y) {
    const std::vector<cv::Point2d> pixels = rawPixels(raw, camera, cx, y);
    for (int x = 0; x < camera.width; ++x) side.resampler.setPlace(x, y, pixels[x]);
  }
  return side;
}

/// Once for each mask, into memory of its own: who has the last result may keep it.
const cv::Mat& StereoRectifier::rectifyMask(const cv::Mat& raw_mask, Side& side) {
  if (raw_mask.data == side.raw_mask.data) return side.mask;
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
  if (calibration != calibration_) {
    const StereoCamera& camera = calibration->rectified;
    left_ = makeSide(calibration->left, camera, camera.cx);
    right_ = makeSide(calibration->right, camera, camera.cx_right);
    calibration_ = calibration;
  }
  workers_.run(2, [&](int part) {
    Side& side = part == 0 ? *left_ : *right_;
    side.resampler.resample(part == 0 ? raw.left : raw.right, side.rectified);
  });
  return {raw.stamp_ns,
          left_->rectified,
          right_->rectified,
          rectifyMask(raw.left_mask, *left_),
          rectifyMask(raw.right_mask, *right_)};
}

}  // namespace rotrocc
