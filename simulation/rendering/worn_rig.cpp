#include "simulation/rendering/worn_rig.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/kitti_camera.h"
#include "simulation/counter_random.h"

namespace rotrocc {
namespace {

constexpr double kMaxMounting_rad = 0.008;  // about each axis
// The raw pixels of real cameras are smaller, with gaps between.
constexpr double kFootprint = 0.5;

/// Tangent of the angle between the optical axis and the corners.
double cornerTangent(const StereoCamera& camera) {
  return 0.5 * std::hypot(camera.width / camera.fx, camera.height / camera.fy);
}

/// The distortion is for the field of view of KITTI's cameras. Lenses for a wider one distort their
/// corners as much.
Lens randomLens(RandomStream& random, double k1, const StereoCamera& camera) {
  const double scale = std::min(1.0, cornerTangent(kittiCamera()) / cornerTangent(camera));
  Lens lens;
  lens.k1 = k1 + random.uniform(-0.005, 0.005);
  lens.k2 = -0.55 * lens.k1 * scale * scale * scale * scale;
  lens.k1 *= scale * scale;
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(Eigen::Vector3d::UnitX()),
                                      Eigen::Vector3d(Eigen::Vector3d::UnitY()),
                                      Eigen::Vector3d(Eigen::Vector3d::UnitZ())}) {
    const double angle = random.uniform(-kMaxMounting_rad, kMaxMounting_rad);
    lens.R_raw_rectified = Eigen::AngleAxisd(angle, axis) * lens.R_raw_rectified;
  }
  return lens;
}

Sensor randomSensor(RandomStream& random, double vignetting) {
  Sensor sensor;
  sensor.noise_sigma = 0.0;
  sensor.vignetting = vignetting + random.uniform(-0.03, 0.03);
  sensor.full_well_e = random.uniform(2e3, 6e3);
  sensor.read_noise_e = random.uniform(5.0, 15.0);
  return sensor;
}

/// The places of the raw pixels in an image that shows all of them without a remainder.
PixelRays raysThrough(const RawImage& raw,
                      const Remainder& remainder,
                      const StereoCamera& camera,
                      double cx) {
  const cv::Mat needed = raw.needed();
  cv::Mat places(raw.size(), CV_64FC2, cv::Scalar::all(std::numeric_limits<double>::quiet_NaN()));
  Eigen::AlignedBox2d bounds;
  for (int y = 0; y < places.rows; ++y) {
    for (int x = 0; x < places.cols; ++x) {
      if (needed.at<uchar>(y, x) == 0) continue;
      const Eigen::Vector2d seen_at = raw.rectified(Eigen::Vector2d(x, y));
      const Eigen::Vector2d place = RawImage::kScale * (seen_at - remainder.at(seen_at));
      places.at<cv::Vec2d>(y, x) = {place.x(), place.y()};
      bounds.extend(place);
    }
  }
  const Eigen::Vector2d first = bounds.min();
  PixelRays rays = {camera, places - cv::Scalar(first.x(), first.y()), kFootprint};
  rays.pinhole.fx *= RawImage::kScale;
  rays.pinhole.fy *= RawImage::kScale;
  rays.pinhole.cx = RawImage::kScale * cx - first.x();
  rays.pinhole.cy = RawImage::kScale * camera.cy - first.y();
  rays.pinhole.width = static_cast<int>(std::ceil(bounds.sizes().x())) + 1;
  rays.pinhole.height = static_cast<int>(std::ceil(bounds.sizes().y())) + 1;
  return rays;
}

}  // namespace

WornCamera::WornCamera(const StereoCamera& camera,
                       double cx,
                       const Lens& lens,
                       const Remainder& remainder,
                       const Sensor& sensor)
    : raw_(lens, camera, cx), sensor_(sensor), rays_(raysThrough(raw_, remainder, camera, cx)) {}

cv::Mat WornCamera::develop(const cv::Mat& brightness, double gain, std::uint64_t noise_key) const {
  return raw_.rectify(rotrocc::develop(brightness, sensor_, gain, noise_key));
}

WornRig wornRig(const StereoCamera& camera, std::uint64_t seed, const Exposure& exposure) {
  RandomStream random(seed, 0x3081);
  const StereoRemainders remainders = randomRemainders(camera, seed);
  const double k1 = random.uniform(-0.38, -0.3);
  const double vignetting = random.uniform(0.2, 0.4);
  const Lens left = randomLens(random, k1, camera);
  const Lens right = randomLens(random, k1, camera);
  const Sensor left_sensor = exposure.of(randomSensor(random, vignetting));
  const Sensor right_sensor = exposure.of(randomSensor(random, vignetting));
  const double day_s = random.uniform(0.002, 0.006);
  return {{camera, camera.cx, left, remainders.left, left_sensor},
          {camera, camera.cx_right, right, remainders.right, right_sensor},
          exposure.time_s > 0.0 ? exposure.time_s : day_s,
          driftingGains(seed),
          windyWeather(seed)};
}

}  // namespace rotrocc
