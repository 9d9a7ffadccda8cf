#include "simulation/rendering/remainder.h"

#include "simulation/counter_random.h"
#include "simulation/kitti_camera.h"

namespace rotrocc {
namespace {

using Coefficients = Remainder::Coefficients;

using Terms = Eigen::Matrix<double, 7, 1>;

Terms termsAt(const Eigen::Vector2d& place) {
  const double x = place.x();
  const double y = place.y();
  Terms terms;
  terms << x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
  return terms;
}

/// A random field that is at most `most_px` in columns and rows, somewhere at the border.
Coefficients randomField(RandomStream& random, const Eigen::Vector2d& most_px) {
  Coefficients field;
  for (int axis = 0; axis < 2; ++axis) {
    for (int term = 0; term < field.cols(); ++term) field(axis, term) = random.uniform(-1.0, 1.0);
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

/// The field of KITTI's disparity errors, within the spread of its clips.
Coefficients disparityField(RandomStream& random) {
  const StereoCamera kitti = kittiCamera();
  const double x = 0.5 * kitti.width / kitti.fx;  // half an image in normalized coordinates
  const double y = 0.5 * kitti.height / kitti.fy;
  Coefficients field = randomField(random, {0.15, random.uniform(0.1, 0.25)});
  field.row(0).head<3>() << random.uniform(1.0, 1.7) * x * x, random.uniform(0.8, 1.6) * x * y,
      random.uniform(-13.6, -7.0) * y * y;
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
  const double columns_px = random.uniform(0.4, 0.8);
  const double rows_px = random.uniform(0.4, 0.8);
  const Coefficients common = randomField(random, {columns_px, rows_px});
  const Coefficients disparity = disparityField(random);
  const double share_of_left = random.uniform(0.3, 0.7);
  return {{scale * (common + share_of_left * disparity), camera, camera.cx},
          {scale * (common - (1.0 - share_of_left) * disparity), camera, camera.cx_right}};
}

}  // namespace rotrocc
