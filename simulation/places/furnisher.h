#pragma once

#include <utility>
#include <vector>

#include "simulation/drives/drive.h"
#include "simulation/scene/body.h"

namespace rotrocc {

/// Places bodies on a level floor (y = 0), clear of the way of a camera and of each other.
class Furnisher {
 public:
  explicit Furnisher(const Drive& drive);

  /// Places a body that stands at (x, z) with its z axis turned to the right by `heading_rad`.
  /// Returns false, without placing it, within `clearance_m` of the way or in another body.
  bool stand(Body body, const Eigen::Vector2d& at, double heading_rad, double clearance_m);

  /// Places a body that is fixed to a wall, the ceiling or another body, wherever it may be: false
  /// only within `clearance_m` of the way.
  bool fix(Body body, const Eigen::Isometry3d& T_world_body, double clearance_m);

  std::vector<Body> takeBodies() { return std::move(bodies_); }

 private:
  bool isOnWay(const Body& body, double clearance_m) const;

  std::vector<Eigen::Vector3d> way_;
  std::vector<Eigen::AlignedBox3d> taken_;
  std::vector<Body> bodies_;
};

}  // namespace rotrocc
