#pragma once

#include <limits>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace rotrocc {

/// Where a camera must be to have all points in its picture. It always looks in the same direction,
/// down at an angle, so its picture is that of a map which grows.
class WholeView {
 public:
  /// A new point, [m].
  void add(const Eigen::Vector3d& point);

  /// The nearest place from which all points are seen, with a margin. Needs a point.
  Eigen::Vector3d position() const;

  /// x is the direction of view, y left and z up in the picture.
  static Eigen::Quaterniond orientation();

 private:
  /// The largest distance of a point beyond a side of the picture, if the camera were at 0.
  double left_ = std::numeric_limits<double>::lowest();
  double right_ = left_, top_ = left_, bottom_ = left_;
};

}  // namespace rotrocc
