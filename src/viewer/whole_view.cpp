#include "viewer/whole_view.h"

#include <algorithm>

namespace rotrocc {
namespace {

/// Of the view "Whole path" in rviz/*.rviz.
constexpr double kPitch_rad = 1.05;
/// Sides of the used part of the picture, as tangents: rviz sees 22.5 deg up and down, more to the
/// sides, and text is below.
constexpr double kSide = 0.42, kTop = 0.33, kBottom = 0.28;

const Eigen::Matrix3d kAxes = WholeView::orientation().toRotationMatrix();
const Eigen::Vector3d kForward = kAxes.col(0);
const Eigen::Vector3d kLeft = kAxes.col(1);
const Eigen::Vector3d kUp = kAxes.col(2);

}  // namespace

Eigen::Quaterniond WholeView::orientation() {
  return Eigen::Quaterniond(Eigen::AngleAxisd(kPitch_rad, Eigen::Vector3d::UnitY()));
}

void WholeView::add(const Eigen::Vector3d& point) {
  const double depth = kForward.dot(point);
  left_ = std::max(left_, kLeft.dot(point) - kSide * depth);
  right_ = std::max(right_, -kLeft.dot(point) - kSide * depth);
  top_ = std::max(top_, kUp.dot(point) - kTop * depth);
  bottom_ = std::max(bottom_, -kUp.dot(point) - kBottom * depth);
}

Eigen::Vector3d WholeView::position() const {
  // Far enough back for both pairs of sides, and in the middle between them.
  const double depth =
      std::min(-(left_ + right_) / (2.0 * kSide), -(top_ + bottom_) / (kTop + kBottom));
  const double left = (left_ - right_) / 2.0;
  const double up = (top_ - bottom_ + (kTop - kBottom) * depth) / 2.0;
  return depth * kForward + left * kLeft + up * kUp;
}

}  // namespace rotrocc
