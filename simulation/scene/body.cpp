#include "simulation/scene/body.h"

#include <algorithm>
#include <utility>

namespace rotrocc {
namespace {

Eigen::AlignedBox3d transformed(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& T) {
  Eigen::AlignedBox3d result;
  for (int corner = 0; corner < 8; ++corner) {
    result.extend(T * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  }
  return result;
}

}  // namespace

bool passes(const Ray& ray, const RayRange& range, const Eigen::AlignedBox3d& box) {
  const Eigen::Array3d inverse = ray.direction.cwiseInverse().array();
  const Eigen::Array3d a = (box.min() - ray.origin).array() * inverse;
  const Eigen::Array3d b = (box.max() - ray.origin).array() * inverse;
  const Eigen::Array3d low = a.min(b);
  const Eigen::Array3d high = a.max(b);
  const double enter = std::max(std::max(low[0], low[1]), std::max(low[2], range.from));
  const double leave = std::min(std::min(high[0], high[1]), std::min(high[2], range.to));
  return enter <= leave;
}

Body::Body(std::vector<Part> parts) : parts_(std::move(parts)) {
  for (const Part& part : parts_) own_bounds_.extend(part.shape->bounds());
  place(Eigen::Isometry3d::Identity());
}

void Body::place(const Eigen::Isometry3d& T_world_body) {
  T_world_body_ = T_world_body;
  T_body_world_ = T_world_body.inverse();
  world_bounds_ = transformed(own_bounds_, T_world_body_);
}

bool Body::blocks(const Ray& ray, const RayRange& range, double pixel_m) const {
  const Ray own = toBody(ray);
  if (!passes(own, range, own_bounds_)) return false;
  BodyHit hit;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (intersectPart(static_cast<int>(i), own, range, pixel_m, hit)) return true;
  }
  return false;
}

bool Body::intersectPart(
    int part, const Ray& own_ray, const RayRange& range, double pixel_m, BodyHit& hit) const {
  const Part& solid = parts_[static_cast<std::size_t>(part)];
  RayRange rest = range;
  ShapeHit crossing;
  while (solid.shape->intersect(own_ray, rest, crossing)) {
    const bool inside = crossing.normal.dot(own_ray.direction) > 0.0;
    if (!solid.material.is_hole ||
        !solid.material.is_hole(
            own_ray.at(crossing.distance), crossing.normal, pixel_m * crossing.distance)) {
      hit = {crossing, part};
      hit.face = 2 * crossing.face + (inside ? 1 : 0);
      if (inside) hit.normal = -crossing.normal;
      return true;
    }
    rest.from = crossing.distance + 1e-6;
  }
  return false;
}

}  // namespace rotrocc
