#include "simulation/rendering/worn_rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "geometry/kitti_camera.h"
#include "simulation/counter_random.h"

namespace rotrocc {
namespace {

constexpr double kTurn_rad = 2.0 * M_PI;
constexpr double kMaxMounting_rad = 0.008;  // about each axis
// The raw pixels of real cameras are smaller, with gaps between.
constexpr double kFootprint = 0.5;
constexpr double kRawScale = 1.15;  // focal length of the raw image over that of the rectified one
constexpr int kMargin_px = 6;       // of the raw image around what the rectified image shows

/// Around `mean`, with an amplitude and a period from these ranges.
GainSwing randomSwing(RandomStream& random,
                      double mean,
                      const std::array<double, 2>& amplitude,
                      const std::array<double, 2>& period_s) {
  const double swing = mean * random.uniform(amplitude[0], amplitude[1]);
  return {mean - swing,
          mean + swing,
          random.uniform(period_s[0], period_s[1]),
          random.uniform(0.0, kTurn_rad)};
}

/// Cameras that follow the brightness of the scene together, up to a few percent.
Gains driftingGains(std::uint64_t seed) {
  RandomStream random(seed, 0x6A1);
  const auto own = [&] {
    const double mean = random.uniform(0.94, 1.06);
    return randomSwing(random, mean, {0.01, 0.04}, {5.0, 15.0});
  };
  Gains gains;
  gains.common = randomSwing(random, 1.0, {0.05, 0.15}, {6.0, 20.0});
  gains.left = own();
  gains.right = own();
  return gains;
}

/// Wind that moves leaves by a few cm, and reflections.
Weather windyWeather(std::uint64_t seed) {
  RandomStream random(seed, 0x817D);
  Weather weather;
  weather.wind.reach_m = random.uniform(0.01, 0.03);
  weather.wind.frequency_hz = random.uniform(0.8, 1.6);
  weather.wind.phase_rad.x() = random.uniform(0.0, 2.0 * M_PI);
  weather.wind.phase_rad.y() = random.uniform(0.0, 2.0 * M_PI);
  weather.reflections = true;
  return weather;
}

/// Coefficients [px] of the terms below, for the columns and the rows.
using Coefficients = Eigen::Matrix<double, 2, 10>;
using Terms = Eigen::Matrix<double, 10, 1>;

constexpr int kX = 1;
constexpr int kY = 2;
constexpr int kX2 = 3;  // the first that lenses have
constexpr int kXY = 4;
constexpr int kY2 = 5;

/// 1, X, Y, X^2, X Y, Y^2, X^3, X^2 Y, X Y^2 and Y^3.
Terms termsAt(const Eigen::Vector2d& place) {
  const double x = place.x();
  const double y = place.y();
  Terms terms;
  terms << 1.0, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
  return terms;
}

/// What calibration leaves in the rectified images of one camera: a smooth field of offsets.
struct Remainder {
  /// What is seen at `pixel` should be seen this much [px] before it.
  Eigen::Vector2d at(const Eigen::Vector2d& pixel) const {
    return coefficients * termsAt((pixel - centre).cwiseQuotient(half_size));
  }

  Coefficients
      coefficients;  // X and Y are 0 at the principal point, +-1 half an image away from it
  Eigen::Vector2d centre;
  Eigen::Vector2d half_size;
};

struct StereoRemainders {
  Remainder left;
  Remainder right;
};

/// A random field of lenses that is at most `most_px` in columns and rows, somewhere at the border.
Coefficients lensField(RandomStream& random, const Eigen::Vector2d& most_px) {
  Coefficients field = Coefficients::Zero();
  for (int axis = 0; axis < 2; ++axis) {
    for (int term = kX2; term < field.cols(); ++term) field(axis, term) = random.uniform(-1.0, 1.0);
  }
  Eigen::Vector2d most = Eigen::Vector2d::Zero();
  for (double along = -1.0; along <= 1.0; along += 0.25) {
    for (const double side : {-1.0, 1.0}) {
      most = most.cwiseMax((field * termsAt({along, side})).cwiseAbs());
      most = most.cwiseMax((field * termsAt({side, along})).cwiseAbs());
    }
  }
  return most_px.cwiseQuotient(most).asDiagonal() * field;
}

/// What both cameras have. With the principal point wrong, motions seem to be turned a little: by 4
/// to 8 mrad on KITTI's clips.
Coefficients commonField(RandomStream& random) {
  const double columns_px = random.uniform(0.4, 0.8);
  const double rows_px = random.uniform(0.4, 0.8);
  Coefficients field = lensField(random, {columns_px, rows_px});
  const double principal_point_px = random.uniform(3.0, 5.5);
  const double direction_rad = random.uniform(0.0, 2.0 * M_PI);
  field(0, 0) = principal_point_px * std::cos(direction_rad);
  field(1, 0) = principal_point_px * std::sin(direction_rad);
  return field;
}

/// KITTI's disparity errors and row differences, left minus right, within the spread of its clips.
Coefficients stereoField(RandomStream& random) {
  const StereoCamera kitti = kittiCamera();
  const double x = 0.5 * kitti.width / kitti.fx;  // half an image in normalized coordinates
  const double y = 0.5 * kitti.height / kitti.fy;
  Coefficients field = lensField(random, {0.15, random.uniform(0.1, 0.25)});
  field(0, 0) = random.uniform(-0.5, -0.2);
  field(0, kX2) = random.uniform(1.0, 1.7) * x * x;
  field(0, kXY) = random.uniform(0.8, 1.6) * x * y;
  field(0, kY2) = random.uniform(-13.6, -7.0) * y * y;
  field(1, 0) = random.uniform(-0.4, 0.4);
  field(1, kX) = random.uniform(-0.4, 0.4) * x;
  field(1, kY) = random.uniform(-0.4, 0.4) * y;
  field(1, kXY) -= random.uniform(6.5, 7.2) * x * y;
  return field;
}

/// Remainders for images of KITTI's size, and in proportion for others. Both cameras have that of
/// their lenses, 0.5 to 1 px, and a wrong principal point. In what they differ by, they are like
/// KITTI's: disparities are wrong by about 1.2 x^2 + 1.2 x y - 11 y^2 - 0.35 px in normalized
/// coordinates, and points are lower in the right image by about 7 x y px.
StereoRemainders randomRemainders(const StereoCamera& camera, std::uint64_t seed) {
  RandomStream random(seed, 0x4E3);
  const double scale = static_cast<double>(camera.width) / kittiCamera().width;
  const Coefficients common = commonField(random);
  const Coefficients stereo = stereoField(random);
  const double share_of_left = random.uniform(0.3, 0.7);
  const Eigen::Vector2d half_size(0.5 * camera.width, 0.5 * camera.height);
  return {
      {scale * (common + share_of_left * stereo), {camera.cx, camera.cy}, half_size},
      {scale * (common - (1.0 - share_of_left) * stereo), {camera.cx_right, camera.cy}, half_size}};
}

/// The lens of one camera, and how the camera is mounted: what rectification takes out.
struct Lens {
  double k1 = 0.0;  // radial distortion: r (1 + k1 r^2 + k2 r^4); rises if 9 k1^2 < 20 k2
  double k2 = 0.0;
  Eigen::Matrix3d R_raw_rectified = Eigen::Matrix3d::Identity();
};

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

/// The raw image of a camera with a lens, which shows all that its rectified image does.
class RawImage {
 public:
  /// The rectified image has the size and focal lengths of `camera`, and the principal point
  /// (cx, camera.cy).
  RawImage(const Lens& lens, const StereoCamera& camera, double cx)
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

  const cv::Size& size() const { return size_; }

  /// CV_32FC2: place in the raw image of each rectified pixel.
  const cv::Mat& map() const { return map_; }

  /// The place in the rectified image of a raw pixel; it may lie outside.
  Eigen::Vector2d rectified(const Eigen::Vector2d& raw) const {
    const Eigen::Vector2d distorted = (raw - raw_centre_).cwiseQuotient(kRawScale * focal_px_);
    const double radius = distorted.norm();
    const double ratio = radius > 0.0 ? undistorted(lens_, radius) / radius : 1.0;
    const Eigen::Vector3d ray =
        lens_.R_raw_rectified.transpose() * (ratio * distorted).homogeneous();
    return focal_px_.cwiseProduct(ray.hnormalized()) + centre_;
  }

  /// CV_8UC1, not 0 for the raw pixels of which the rectified image is made, and those around them.
  cv::Mat needed() const {
    cv::Mat needed(size_, CV_8UC1, cv::Scalar(0));
    for (const cv::Vec2f& place : cv::Mat_<cv::Vec2f>(map_)) {
      needed.at<uchar>(static_cast<int>(place[1]), static_cast<int>(place[0])) = 1;
    }
    const int width = 2 * kMargin_px + 1;
    cv::dilate(needed, needed, cv::getStructuringElement(cv::MORPH_RECT, {width, width}));
    return needed;
  }

 private:
  /// The place in the raw image of a rectified pixel.
  Eigen::Vector2d raw(const Eigen::Vector2d& rectified) const {
    const Eigen::Vector2d place = (rectified - centre_).cwiseQuotient(focal_px_);
    const Eigen::Vector2d turned = (lens_.R_raw_rectified * place.homogeneous()).hnormalized();
    return kRawScale * stretch(lens_, turned.squaredNorm()) * focal_px_.cwiseProduct(turned) +
           raw_centre_;
  }

  Lens lens_;
  Eigen::Vector2d focal_px_;
  Eigen::Vector2d centre_;  // principal point of the rectified image
  Eigen::Vector2d raw_centre_ = Eigen::Vector2d::Zero();
  cv::Size size_;
  cv::Mat map_;
};

Sensor randomSensor(RandomStream& random, double vignetting) {
  Sensor sensor;
  sensor.noise_sigma = 0.0;
  sensor.vignetting = vignetting + random.uniform(-0.03, 0.03);
  sensor.full_well_e = random.uniform(2e3, 6e3);
  sensor.read_noise_e = random.uniform(5.0, 15.0);
  return sensor;
}

/// The rays of the raw pixels, through an image without a remainder.
PixelRays raysOf(const RawImage& raw,
                 const Remainder& remainder,
                 const StereoCamera& camera,
                 double cx) {
  const cv::Mat needed = raw.needed();
  cv::Mat places(raw.size(), CV_64FC2, cv::Scalar::all(std::numeric_limits<double>::quiet_NaN()));
  for (int y = 0; y < places.rows; ++y) {
    for (int x = 0; x < places.cols; ++x) {
      if (needed.at<uchar>(y, x) == 0) continue;
      const Eigen::Vector2d seen_at = raw.rectified(Eigen::Vector2d(x, y));
      const Eigen::Vector2d place = kRawScale * (seen_at - remainder.at(seen_at));
      places.at<cv::Vec2d>(y, x) = {place.x(), place.y()};
    }
  }
  PixelRays rays = raysThrough(places,
                               kRawScale * camera.fx,
                               kRawScale * camera.fy,
                               {kRawScale * cx, kRawScale * camera.cy});
  rays.footprint = kFootprint;
  return rays;
}

WornCamera wornCamera(const StereoCamera& camera,
                      double cx,
                      const Lens& lens,
                      const Remainder& remainder,
                      const Sensor& sensor) {
  const RawImage raw(lens, camera, cx);
  return {raysOf(raw, remainder, camera, cx), raw.map(), sensor};
}

}  // namespace

double GainSwing::at(double time_s) const {
  const double share = 0.5 + 0.5 * std::sin(kTurn_rad * time_s / period_s + phase_rad);
  return low + (high - low) * share;
}

cv::Mat WornCamera::develop(const cv::Mat& brightness, double gain, std::uint64_t noise_key) const {
  cv::Mat rectified;
  cv::remap(rotrocc::develop(brightness, sensor, gain, noise_key),
            rectified,
            raw_place,
            cv::Mat(),
            cv::INTER_LINEAR,
            cv::BORDER_REPLICATE);
  return rectified;
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
  return {wornCamera(camera, camera.cx, left, remainders.left, left_sensor),
          wornCamera(camera, camera.cx_right, right, remainders.right, right_sensor),
          exposure.time_s > 0.0 ? exposure.time_s : day_s,
          driftingGains(seed),
          windyWeather(seed)};
}

}  // namespace rotrocc
