#include "simulation/rendering/picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulation/rows.h"

namespace rotrocc {
namespace {

constexpr double kSharp_px = 0.25;  // a shorter path is not blurred
constexpr int kMaxTaps = 12;

/// Bilinear; outside the nearest pixel.
double sample(const cv::Mat& image, const Eigen::Vector2d& at) {
  const double x = std::clamp(at.x(), 0.0, image.cols - 1.001);
  const double y = std::clamp(at.y(), 0.0, image.rows - 1.001);
  const auto column = static_cast<int>(x);
  const auto row = static_cast<int>(y);
  const double right = x - column;
  const float* upper = image.ptr<float>(row) + column;
  const float* lower = image.ptr<float>(row + 1) + column;
  const double top = upper[0] + right * (upper[1] - upper[0]);
  const double bottom = lower[0] + right * (lower[1] - lower[0]);
  return top + (y - row) * (bottom - top);
}

double meanAlong(const cv::Mat& image, const Eigen::Vector2d& middle, const Eigen::Vector2d& path) {
  const int taps = std::min(kMaxTaps, 2 + static_cast<int>(path.norm()));
  double sum = 0.0;
  for (int tap = 0; tap < taps; ++tap) {
    sum += sample(image, middle + ((tap + 0.5) / taps - 0.5) * path);
  }
  return sum / taps;
}

}  // namespace

PixelRays raysThrough(const cv::Mat& places, double fx, double fy, const Eigen::Vector2d& centre) {
  Eigen::AlignedBox2d bounds;
  for (const cv::Vec2d& place : cv::Mat_<cv::Vec2d>(places)) {
    if (!std::isnan(place[0])) bounds.extend(Eigen::Vector2d(place[0], place[1]));
  }
  const Eigen::Vector2d first = bounds.min();
  PixelRays rays;
  rays.places = places - cv::Scalar(first.x(), first.y());
  rays.pinhole.fx = fx;
  rays.pinhole.fy = fy;
  rays.pinhole.cx = centre.x() - first.x();
  rays.pinhole.cy = centre.y() - first.y();
  rays.pinhole.width = static_cast<int>(std::ceil(bounds.sizes().x())) + 1;
  rays.pinhole.height = static_cast<int>(std::ceil(bounds.sizes().y())) + 1;
  return rays;
}

Eigen::Vector2d flowAt(
    int x, int y, const Picture& picture, const PixelRays& rays, const SeenMotions& motions) {
  const Eigen::Vector2d place = rays.place(x, y);
  const Eigen::Vector3d ray = rays.pinhole.ray(place);
  const double depth = picture.depth.at<double>(y, x);
  const int car = picture.moving_car.at<int>(y, x);
  const Eigen::Isometry3d& motion = car < 0 ? motions.back() : motions[car];
  const Eigen::Vector3d point = std::isinf(depth) ? Eigen::Vector3d(motion.linear() * ray)
                                                  : Eigen::Vector3d(motion * (depth * ray));
  if (point.z() > 0.0) return rays.pinhole.project(point) - place;
  return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
}

cv::Mat blurred(const Picture& picture, const PixelRays& rays, const SeenMotions& motions) {
  cv::Mat result = picture.brightness.clone();
  forEachRow(result.rows, [&](int y) {
    for (int x = 0; x < result.cols; ++x) {
      const Eigen::Vector2d path = flowAt(x, y, picture, rays, motions);
      if (!(path.norm() > kSharp_px)) continue;  // also not NaN
      result.at<float>(y, x) =
          static_cast<float>(meanAlong(picture.brightness, Eigen::Vector2d(x, y), path));
    }
  });
  return result;
}

}  // namespace rotrocc
