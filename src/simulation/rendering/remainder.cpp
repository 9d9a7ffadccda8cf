#include "simulation/rendering/remainder.h"

#include "simulation/counter_random.h"
#include "simulation/kitti_camera.h"

namespace rotrocc {
namespace {

using Coefficients = Remainder::Coefficients;

/// Random coefficients whose absolute values add up to `sum_px` for the columns and for the rows.
Coefficients randomField(RandomStream& random, double columns_px, double rows_px) {
  Coefficients field;
  for (int axis = 0; axis < 2; ++axis) {
    for (int term = 0; term < field.cols(); ++term) field(axis, term) = random.uniform(-1.0, 1.0);
    field.row(axis) *= (axis == 0 ? columns_px : rows_px) / field.row(axis).lpNorm<1>();
  }
  return field;
}

/// The field of KITTI's disparity errors, within the spread of its clips.
Coefficients disparityField(RandomStream& random) {
  const StereoCamera kitti = kittiCamera();
  const double x = 0.5 * kitti.width / kitti.fx;  // half an image in normalized coordinates
  const double y = 0.5 * kitti.height / kitti.fy;
  Coefficients field = randomField(random, 0.2, random.uniform(0.1, 0.3));
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
  const Eigen::Vector2d place = (pixel - centre_).cwiseQuotient(half_size_);
  const double x = place.x();
  const double y = place.y();
  Eigen::Matrix<double, 7, 1> terms;
  terms << x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
  return coefficients_ * terms;
}

StereoRemainders randomRemainders(const StereoCamera& camera, std::uint64_t seed) {
  RandomStream random(seed, 0x4E3);
  const double scale = static_cast<double>(camera.width) / kittiCamera().width;
  const double common_px = random.uniform(0.5, 1.0);
  const Coefficients common = randomField(random, common_px, common_px);
  const Coefficients disparity = disparityField(random);
  const double share_of_left = random.uniform(0.3, 0.7);
  return {{scale * (common + share_of_left * disparity), camera, camera.cx},
          {scale * (common - (1.0 - share_of_left) * disparity), camera, camera.cx_right}};
}

}  // namespace rotrocc
