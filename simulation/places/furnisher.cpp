#include "simulation/places/furnisher.h"

#include <algorithm>
#include <utility>

namespace rotrocc {

Furnisher::Furnisher(const Drive& drive) {
  constexpr double kStep_s = 0.05;
  for (double time_s = 0.0; time_s < drive.duration_s(); time_s += kStep_s) {
    way_.push_back(drive.pose(time_s).translation());
  }
}

bool Furnisher::stand(Body body,
                      const Eigen::Vector2d& at,
                      double heading_rad,
                      double clearance_m) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << at.x(), 0.0, at.y();
  pose.rotate(Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitY()));
  body.place(pose);
  if (isOnWay(body, clearance_m)) return false;
  if (std::any_of(taken_.begin(), taken_.end(), [&](const Eigen::AlignedBox3d& other) {
        return other.intersects(body.bounds());
      })) {
    return false;
  }
  taken_.push_back(body.bounds());
  body.contact_shadow = true;
  bodies_.push_back(std::move(body));
  return true;
}

bool Furnisher::fix(Body body, const Eigen::Isometry3d& T_world_body, double clearance_m) {
  body.place(T_world_body);
  if (isOnWay(body, clearance_m)) return false;
  bodies_.push_back(std::move(body));
  return true;
}

bool Furnisher::isOnWay(const Body& body, double clearance_m) const {
  return std::any_of(way_.begin(), way_.end(), [&](const Eigen::Vector3d& position) {
    return body.bounds().exteriorDistance(position) < clearance_m;
  });
}

}  // namespace rotrocc
