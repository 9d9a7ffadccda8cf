#include "check/rig_causes.h"

#include <Eigen/Geometry>

namespace rotrocc {

Eigen::Matrix3d rotationOf(const RigCauses& causes) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(causes[kYaw], Vector3d::UnitY()) *
          AngleAxisd(causes[kPitch], Vector3d::UnitX()) *
          AngleAxisd(causes[kRoll], Vector3d::UnitZ()))
      .toRotationMatrix();
}

Eigen::Vector2d RigDisplacement::of(const RigSample& sample) const {
  const Eigen::Vector2d straight(sample.x_right, sample.y);
  const Eigen::Vector2d turned = (R_right_left_ * straight.homogeneous()).hnormalized();
  const double scale = (1.0 + causes_[kFocal]) * (1.0 + causes_[kLens] * turned.squaredNorm());
  const Eigen::Vector2d moved = scale * turned - straight;
  const double twisted = causes_[kTwist] * sample.x_right * sample.y;
  return Eigen::Vector2d(camera_.fx * moved.x() + causes_[kBias],
                         camera_.fy * (moved.y() - twisted) + causes_[kOffset]) +
         causes_[kTimeSkew] * sample.velocity_pxps;
}

}  // namespace rotrocc
