#pragma once

#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "simulation/scene/shape.h"
#include "simulation/surfaces/material.h"

namespace rotrocc {

struct Part {
  std::shared_ptr<const Shape> shape;
  Material material;
};

/// First hit of a ray, with the normal in the frame of the body, towards the viewer.
struct BodyHit : ShapeHit {
  int part;
};

/// A rigid body of one or more parts: a house, a car, a tree.
class Body {
 public:
  explicit Body(std::vector<Part> parts);

  /// Sets the pose, which maps points of the body's frame to the world.
  void place(const Eigen::Isometry3d& T_world_body);

  const Eigen::Isometry3d& T_world_body() const { return T_world_body_; }
  const std::vector<Part>& parts() const { return parts_; }

  const Eigen::AlignedBox3d& bounds() const { return world_bounds_; }
  /// In the frame of the body.
  const Eigen::AlignedBox3d& ownBounds() const { return own_bounds_; }

  /// Whether it blocks a ray of the world in `range`. A pixel is `pixel_m` wide at distance 1.
  bool blocks(const Ray& ray, const RayRange& range, double pixel_m) const;

  /// First hit of a ray in the frame of the body with one part; false if there is none.
  bool intersectPart(
      int part, const Ray& own_ray, const RayRange& range, double pixel_m, BodyHit& hit) const;

  Ray toBody(const Ray& ray) const {
    return {T_body_world_ * ray.origin, T_body_world_.linear() * ray.direction};
  }

  Eigen::Vector3d toBody(const Eigen::Vector3d& point) const { return T_body_world_ * point; }
  PixelSpread toBody(const PixelSpread& spread) const {
    return {T_body_world_.linear() * spread.per_column, T_body_world_.linear() * spread.per_row};
  }

  double lit = 1.0;             ///< visible share of the direct light, from 0 to 1
  bool contact_shadow = false;  ///< darkens the ground below and close to it
  bool own_shade = false;       ///< small: is shaded as a whole by its surroundings

 private:
  std::vector<Part> parts_;
  Eigen::AlignedBox3d own_bounds_;
  Eigen::AlignedBox3d world_bounds_;
  Eigen::Isometry3d T_world_body_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_body_world_ = Eigen::Isometry3d::Identity();
};

/// Whether a ray hits a box in `range`.
bool passes(const Ray& ray, const RayRange& range, const Eigen::AlignedBox3d& box);

}  // namespace rotrocc
