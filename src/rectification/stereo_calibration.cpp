#include "rectification/stereo_calibration.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <opencv2/core.hpp>

namespace rotrocc {
namespace {

constexpr int kMaxSize_px = 32000;      // 16 bits of the places in a raw image
constexpr double kMaxDeviation = 1e-3;  // of a rotation printed with four digits or more

void requirePositive(const char* name, double value) {
  if (std::isfinite(value) && value > 0.0) return;
  throw std::invalid_argument(cv::format("%s is %g, but must be positive", name, value));
}

bool isRectifiedBy(const RawCamera& raw, const StereoCamera& camera, double cx) {
  constexpr double kSame_px = 1e-2;
  constexpr double kSame_rad = 1e-5;
  const double difference = std::max({std::abs(raw.fx - camera.fx),
                                      std::abs(raw.fy - camera.fy),
                                      std::abs(raw.cx - cx),
                                      std::abs(raw.cy - camera.cy)});
  return raw.distortion.isNone() && difference < kSame_px &&
         raw.R_rectified_raw.isIdentity(kSame_rad);
}

RawCamera asRaw(const StereoCamera& camera, double cx) {
  return {camera.width,
          camera.height,
          camera.fx,
          camera.fy,
          cx,
          camera.cy,
          {},
          Eigen::Matrix3d::Identity()};
}

void requireSideBySide(const Eigen::Isometry3d& T_left_right) {
  constexpr double kMaxAngle_deg = 45.0;
  const Eigen::Vector3d& right = T_left_right.translation();
  const double turn_deg = Eigen::AngleAxisd(T_left_right.linear()).angle() * 180.0 / M_PI;
  if (!(turn_deg < kMaxAngle_deg)) {
    throw std::invalid_argument(
        cv::format("the right camera is turned against the left one by %g degrees: check the poses "
                   "of the cameras",
                   turn_deg));
  }
  if (!(right.norm() > 1e-6)) {
    throw std::invalid_argument("the baseline is zero: check the poses of the cameras");
  }
  if (right.x() < std::cos(kMaxAngle_deg * M_PI / 180.0) * right.norm()) {
    std::ostringstream message;
    message << "the right camera is at " << right.transpose()
            << " m in the frame of the left one (right, down, forward), but must be to its right: "
               "are left and right swapped, or the poses of the cameras inverted?";
    throw std::invalid_argument(message.str());
  }
}

/// Whether a camera sees all of these rays in the rectified frame.
bool sees(const RawCamera& raw, std::vector<Eigen::Vector3d> rays) {
  for (Eigen::Vector3d& ray : rays) {
    ray = raw.R_rectified_raw.transpose() * ray;
    if (!(ray.z() > 0.0 && ray.hnormalized().norm() <= raw.distortion.limit())) return false;
  }
  const std::vector<cv::Point2d> pixels = raw.project(rays);
  return std::all_of(pixels.begin(), pixels.end(), [&](const cv::Point2d& p) {
    return p.x >= 0.0 && p.y >= 0.0 && p.x <= raw.width - 1 && p.y <= raw.height - 1;
  });
}

/// What the center of a raw image shows, in normalized coordinates of the rectified one.
Eigen::Vector2d centerOf(const RawCamera& raw) {
  const cv::Point2d center(0.5 * (raw.width - 1), 0.5 * (raw.height - 1));
  return (raw.R_rectified_raw * raw.rays({center})[0]).hnormalized();
}

/// Sets focal lengths and principal point of the largest image that both cameras see. The middle of
/// what both show is in its middle.
void fitImage(StereoCalibration& calibration) {
  const RawCamera& left = calibration.left;
  const RawCamera& right = calibration.right;
  StereoCamera& camera = calibration.rectified;
  const Eigen::Vector2d middle = 0.5 * (centerOf(left) + centerOf(right));
  const auto isSeenWith = [&](double focal) {
    const double x_end = camera.width - 1;
    const double y_end = camera.height - 1;
    camera.fx = camera.fy = focal;
    camera.cx = camera.cx_right = 0.5 * x_end - focal * middle.x();
    camera.cy = 0.5 * y_end - focal * middle.y();
    std::vector<Eigen::Vector3d> border;
    for (double x = 0; x <= x_end; ++x) {
      for (const double y : {0.0, y_end}) border.push_back(camera.ray({x, y}));
    }
    for (double y = 0; y <= y_end; ++y) {
      for (const double x : {0.0, x_end}) border.push_back(camera.ray({x, y}));
    }
    return sees(left, border) && sees(right, border);
  };
  const double raw_focal = std::min({left.fx, left.fy, right.fx, right.fy});
  double small = 0.7 * raw_focal;
  double large = 4.0 * raw_focal;
  if (isSeenWith(small)) return;
  if (!isSeenWith(large)) {
    throw std::invalid_argument(
        "the cameras share no view: check their intrinsics and their poses");
  }
  for (int i = 0; i < 40; ++i) {
    const double focal = 0.5 * (small + large);
    (isSeenWith(focal) ? large : small) = focal;
  }
  isSeenWith(large);
}

}  // namespace

void RawCamera::check() const {
  requirePositive("width", width);
  requirePositive("height", height);
  if (std::max(width, height) > kMaxSize_px) {
    throw std::invalid_argument(cv::format("its images are larger than %d px", kMaxSize_px));
  }
  requirePositive("fx", fx);
  requirePositive("fy", fy);
  if (!std::isfinite(cx) || !std::isfinite(cy)) {
    throw std::invalid_argument(cv::format("the principal point %g %g is not finite", cx, cy));
  }
  const Eigen::Matrix3d deviation =
      R_rectified_raw * R_rectified_raw.transpose() - Eigen::Matrix3d::Identity();
  if (!(deviation.cwiseAbs().maxCoeff() < kMaxDeviation) || R_rectified_raw.determinant() < 0.0) {
    throw std::invalid_argument(
        "the rectification matrix R is not a rotation: calibrate the cameras as a pair");
  }
}

std::vector<cv::Point2d> RawCamera::project(const std::vector<Eigen::Vector3d>& points) const {
  std::vector<cv::Point2d> pixels;
  for (const Eigen::Vector3d& p : points) pixels.emplace_back(p.x() / p.z(), p.y() / p.z());
  pixels = distortion.distort(std::move(pixels));
  for (cv::Point2d& pixel : pixels) pixel = {fx * pixel.x + cx, fy * pixel.y + cy};
  return pixels;
}

std::vector<Eigen::Vector3d> RawCamera::rays(std::vector<cv::Point2d> pixels) const {
  for (cv::Point2d& pixel : pixels) pixel = {(pixel.x - cx) / fx, (pixel.y - cy) / fy};
  std::vector<Eigen::Vector3d> rays;
  for (const cv::Point2d& p : distortion.undistort(pixels)) rays.emplace_back(p.x, p.y, 1.0);
  return rays;
}

bool StereoCalibration::isRectified() const {
  return isLeftRectified() && isRectifiedBy(right, rectified, rectified.cx_right);
}

bool StereoCalibration::isLeftRectified() const {
  return isRectifiedBy(left, rectified, rectified.cx);
}

StereoCalibration rectifiedCalibration(const StereoCamera& camera) {
  return {asRaw(camera, camera.cx), asRaw(camera, camera.cx_right), camera};
}

StereoCalibration chooseRectification(const RawCamera& left,
                                      const RawCamera& right,
                                      const Eigen::Isometry3d& T_left_right) {
  left.check();
  right.check();
  if (left.width != right.width || left.height != right.height) {
    throw std::invalid_argument(
        cv::format("the left camera has %dx%d px, ", left.width, left.height) +
        cv::format(
            "the right one %dx%d px: both must have the same size", right.width, right.height));
  }
  requireSideBySide(T_left_right);

  const Eigen::AngleAxisd turn(T_left_right.linear());
  const Eigen::AngleAxisd half(0.5 * turn.angle(), turn.axis());
  const Eigen::Vector3d baseline = half.inverse() * T_left_right.translation();
  const Eigen::Quaterniond along_x =
      Eigen::Quaterniond::FromTwoVectors(baseline, Eigen::Vector3d::UnitX());
  StereoCalibration calibration = {left, right, {}};
  calibration.left.R_rectified_raw = (along_x * half.inverse()).toRotationMatrix();
  calibration.right.R_rectified_raw = (along_x * half).toRotationMatrix();
  calibration.rectified.width = left.width;
  calibration.rectified.height = left.height;
  calibration.rectified.baseline_m = baseline.norm();
  fitImage(calibration);
  return calibration;
}

}  // namespace rotrocc
