#include "simulation/rendering/lens.h"

#include <cmath>

#include <opencv2/imgproc.hpp>

#include "simulation/rows.h"

namespace rotrocc {
namespace {

constexpr int kMargin_px = 6;  // around what the rectified image shows

double stretch(const Lens& lens, double squared_radius) {
  return 1.0 + squared_radius * (lens.k1 + squared_radius * lens.k2);
}

/// Inverse of r * stretch(r^2).
double undistorted(const Lens& lens, double distorted_radius) {
  double r = distorted_radius;
  for (int i = 0; i < 6; ++i) {  // Newton; from below, where the function is steep
    const double square = r * r;
    const double slope = 1.0 + square * (3.0 * lens.k1 + 5.0 * square * lens.k2);
    r -= (r * stretch(lens, square) - distorted_radius) / slope;
  }
  return r;
}

}  // namespace

RawImage::RawImage(const Lens& lens, const StereoCamera& camera, double cx)
    : lens_(lens),
      focal_px_(camera.fx, camera.fy),
      centre_(cx, camera.cy),
      map_(camera.height, camera.width, CV_32FC2) {
  Eigen::AlignedBox2d bounds;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) bounds.extend(raw(Eigen::Vector2d(x, y)));
  }
  raw_centre_ = Eigen::Vector2d::Constant(kMargin_px) - bounds.min();
  const Eigen::Vector2d size = bounds.sizes() + Eigen::Vector2d::Constant(2.0 * kMargin_px);
  size_ = {static_cast<int>(std::ceil(size.x())), static_cast<int>(std::ceil(size.y()))};
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector2f place = raw(Eigen::Vector2d(x, y)).cast<float>();
      map_.at<cv::Vec2f>(y, x) = {place.x(), place.y()};
    }
  }
}

Eigen::Vector2d RawImage::rectified(const Eigen::Vector2d& raw) const {
  const Eigen::Vector2d distorted = (raw - raw_centre_).cwiseQuotient(kScale * focal_px_);
  const double radius = distorted.norm();
  const double ratio = radius > 0.0 ? undistorted(lens_, radius) / radius : 1.0;
  const Eigen::Vector3d ray = lens_.R_raw_rectified.transpose() * (ratio * distorted).homogeneous();
  return focal_px_.cwiseProduct(ray.hnormalized()) + centre_;
}

Eigen::Vector2d RawImage::raw(const Eigen::Vector2d& rectified) const {
  const Eigen::Vector2d place = (rectified - centre_).cwiseQuotient(focal_px_);
  const Eigen::Vector2d turned = (lens_.R_raw_rectified * place.homogeneous()).hnormalized();
  return kScale * stretch(lens_, turned.squaredNorm()) * focal_px_.cwiseProduct(turned) +
         raw_centre_;
}

cv::Mat RawImage::needed() const {
  cv::Mat needed(size_, CV_8UC1, cv::Scalar(0));
  for (const cv::Vec2f& place : cv::Mat_<cv::Vec2f>(map_)) {
    needed.at<uchar>(static_cast<int>(place[1]), static_cast<int>(place[0])) = 1;
  }
  const int width = 2 * kMargin_px + 1;
  cv::dilate(needed, needed, cv::getStructuringElement(cv::MORPH_RECT, {width, width}));
  return needed;
}

cv::Mat RawImage::rectify(const cv::Mat& image) const {
  cv::Mat rectified;
  cv::remap(image, rectified, map_, cv::Mat(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return rectified;
}

}  // namespace rotrocc
