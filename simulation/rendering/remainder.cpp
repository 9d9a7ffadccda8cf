#include "simulation/rendering/remainder.h"

#include <cmath>

#include "geometry/kitti_camera.h"
#include "simulation/counter_random.h"

namespace rotrocc {
namespace {

using Coefficients = Remainder::Coefficients;

using Terms = Eigen::Matrix<double, 10, 1>;

constexpr int kX = 1;
constexpr int kY = 2;
constexpr int kX2 = 3;  // the first that lenses have
constexpr int kXY = 4;
constexpr int kY2 = 5;

Terms termsAt(const Eigen::Vector2d& place) {
  const double x = place.x();
  const double y = place.y();
  Terms terms;
  terms << 1.0, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
  return terms;
}

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

}  // namespace

Remainder::Remainder(const Coefficients& coefficients, const StereoCamera& camera, double cx)
    : coefficients_(coefficients),
      centre_(cx, camera.cy),
      half_size_(0.5 * camera.width, 0.5 * camera.height) {}

Eigen::Vector2d Remainder::at(const Eigen::Vector2d& pixel) const {
  return coefficients_ * termsAt((pixel - centre_).cwiseQuotient(half_size_));
}

StereoRemainders randomRemainders(const StereoCamera& camera, std::uint64_t seed) {
  RandomStream random(seed, 0x4E3);
  const double scale = static_cast<double>(camera.width) / kittiCamera().width;
  const Coefficients common = commonField(random);
  const Coefficients stereo = stereoField(random);
  const double share_of_left = random.uniform(0.3, 0.7);
  return {{scale * (common + share_of_left * stereo), camera, camera.cx},
          {scale * (common - (1.0 - share_of_left) * stereo), camera, camera.cx_right}};
}

}  // namespace rotrocc
