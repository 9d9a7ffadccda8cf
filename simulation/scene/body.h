#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "simulation/scene/shape.h"
#include "simulation/surfaces/material.h"

namespace rotrocc {

/// A solid with its material.
struct Part {
  std::shared_ptr<const Shape> shape;
  std::shared_ptr<const Material> material;
};

/// First hit of a ray.
struct BodyHit {
  double distance;
  Eigen::Vector3d normal;  ///< in the frame of the body, towards the viewer
  int part;
  int face;
};

/// A rigid body of one or more parts: a house, a car, a tree.
class Body {
 public:
  explicit Body(std::vector<Part> parts);

  /// Sets the pose, which maps points of the body's frame to the world.
  void place(const Eigen::Isometry3d& T_world_body);

  const Eigen::Isometry3d& T_world_body() const { return T_world_body_; }
  const std::vector<Part>& parts() const { return parts_; }

  /// Bounding box in the world.
  const Eigen::AlignedBox3d& bounds() const { return world_bounds_; }

  /// Bounding box in the frame of the body.
  const Eigen::AlignedBox3d& ownBounds() const { return own_bounds_; }

  /// Whether it blocks a ray of the world in `range`. A pixel is `pixel_m` wide at distance 1.
  bool blocks(const Ray& ray, const RayRange& range, double pixel_m) const;

  /// First hit of a ray in the frame of the body with one part; false if there is none.
  bool intersectPart(
      int part, const Ray& own_ray, const RayRange& range, double pixel_m, BodyHit& hit) const;

  /// The same ray in the frame of the body; distances stay what they are.
  Ray toBody(const Ray& ray) const {
    return {T_body_world_ * ray.origin, T_body_world_.linear() * ray.direction};
  }

  Eigen::Vector3d toBody(const Eigen::Vector3d& point) const { return T_body_world_ * point; }
  PixelSpread toBody(const PixelSpread& spread) const {
    return {T_body_world_.linear() * spread.per_column, T_body_world_.linear() * spread.per_row};
  }

  double lit = 1.0;                     ///< visible share of the direct light, from 0 to 1
  bool contact_shadow = false;          ///< darkens the ground below and close to it
  bool own_shade = false;               ///< small: is shaded as a whole by its surroundings
  std::optional<Eigen::Vector3d> lamp;  ///< of a street lamp: where it shines, in its frame

 private:
  std::vector<Part> parts_;
  Eigen::AlignedBox3d own_bounds_;
  Eigen::AlignedBox3d world_bounds_;
  Eigen::Isometry3d T_world_body_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_body_world_ = Eigen::Isometry3d::Identity();
};

/// Intersects boxes with a ray.
class BoxTest {
 public:
  explicit BoxTest(const Ray& ray)
      : origin_(ray.origin), inverse_direction_(ray.direction.cwiseInverse()) {}

  /// Whether the ray hits the box in `range`.
  bool passes(const RayRange& range, const Eigen::AlignedBox3d& box) const;

 private:
  Eigen::Vector3d origin_;
  Eigen::Vector3d inverse_direction_;
};

}  // namespace rotrocc
