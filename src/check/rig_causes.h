#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// What makes a pair differ from a rectified one.
enum RigCause {
  kRoll,      ///< [rad] rotation of the right camera about its optical axis: clockwise
  kPitch,     ///< [rad] about x: looks up
  kYaw,       ///< [rad] about y: looks right
  kFocal,     ///< focal length of the right image over that of the left one, minus 1
  kOffset,    ///< [px] principal point of the right image, how much lower
  kLens,      ///< k1 that the right image has too much, in normalized coordinates
  kTimeSkew,  ///< [s] how much later the right image is taken
  kBias,      ///< [px] principal point of the right image, how much further right
  kTwist,     ///< [rad] rows like those of a yaw, without its errors of disparities: of a lens
  // Of both images; only flows and, of kBothLenses, rows show them:
  kBothLenses,  ///< k1 that they have too much
  kBothX,       ///< [px] principal points, how much further right
  kBothY        ///< [px] how much lower
};
constexpr std::size_t kRigCauses = 12;

using RigCauses = std::array<double, kRigCauses>;

/// Rotation R_left_right of the right camera that the causes are.
inline Eigen::Matrix3d rotationOf(const RigCauses& causes) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(causes[kYaw], Vector3d::UnitY()) *
          AngleAxisd(causes[kPitch], Vector3d::UnitX()) *
          AngleAxisd(causes[kRoll], Vector3d::UnitZ()))
      .toRotationMatrix();
}

/// A feature of a pair.
struct RigSample {
  cv::Point2f left_px;
  double x_right = 0.0;  ///< normalized coordinate in the right image
  double y = 0.0;        ///< normalized coordinate in the left image
  double row_px = NAN;   ///< how much lower the feature is in the right image; nan: not measured
  Eigen::Vector2d velocity_pxps = Eigen::Vector2d::Zero();  ///< in the right image

  // Errors of its flow, linear in errors of its disparity and of the motion:
  Eigen::Vector2d flow_px = Eigen::Vector2d::Zero();            ///< measured, minus the motion's
  Eigen::Vector2d flow_by_disparity = Eigen::Vector2d::Zero();  ///< zero: says nothing
  double damping_ppx = 0.0;  ///< a large error d counts as d / (1 + damping d): perspective
  /// By kBothLenses, kBothX and kBothY.
  Eigen::Matrix<double, 2, 3> flow_by_both = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix<double, 2, 6> flow_by_motion = Eigen::Matrix<double, 2, 6>::Zero();
};

/// The samples of a pair, which share the error of its motion.
struct PairSamples {
  double time_s = 0.0;
  double flow_noise_px = 1.0;
  double applied_px = 0.0;  ///< bias of the disparities that flows are of
  std::vector<RigSample> samples;
  double late_s = 0.0;  ///< delay that is corrected in these disparities
};

/// What the causes do to the right image.
class RigDisplacement {
 public:
  RigDisplacement(const StereoCamera& camera, const RigCauses& causes)
      : camera_(camera), causes_(causes), R_right_left_(rotationOf(causes).transpose()) {}

  /// How much further right, and lower, a feature is [px].
  Eigen::Vector2d of(const RigSample& sample) const {
    Eigen::Vector2d moved_px(0.0, 0.0);  // a feature is seen where the causes have moved it to
    for (int i = 0; i < 3; ++i)
      moved_px = from({sample.x_right - moved_px.x() / camera_.fx, sample.y}, sample);
    return moved_px;
  }

 private:
  Eigen::Vector2d from(const Eigen::Vector2d& straight, const RigSample& sample) const {
    const Eigen::Vector2d turned = (R_right_left_ * straight.homogeneous()).hnormalized();
    const double scale = (1.0 + causes_[kFocal]) * (1.0 + causes_[kLens] * turned.squaredNorm());
    // Both lenses move a row by its distances from their middles, which differ by the disparity.
    const double x_left = (sample.left_px.x - camera_.cx) / camera_.fx;
    const double bent = causes_[kBothLenses] * (std::pow(straight.x(), 2) - std::pow(x_left, 2));
    const double lower = (bent - causes_[kTwist] * straight.x()) * straight.y();
    const Eigen::Vector2d moved = scale * turned - straight + Eigen::Vector2d(0.0, lower);
    return Eigen::Vector2d(camera_.fx * moved.x() + causes_[kBias],
                           camera_.fy * moved.y() + causes_[kOffset]) +
           causes_[kTimeSkew] * sample.velocity_pxps;
  }

  const StereoCamera& camera_;
  RigCauses causes_;
  Eigen::Matrix3d R_right_left_;
};

}  // namespace rotrocc
