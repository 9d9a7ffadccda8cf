#pragma once

#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "simulation/material.h"
#include "simulation/shape.h"

namespace rotrocc {

/// A solid and what it is made of.
struct Part {
  std::shared_ptr<const Shape> shape;
  std::shared_ptr<const Material> material;
};

/// What a ray meets first.
struct BodyHit {
  double distance;
  Eigen::Vector3d normal;  ///< in the frame of the body, towards the viewer
  int part;
  int face;
};

/// A rigid thing of one or more parts: a house, a car, a tree.
class Body {
 public:
  explicit Body(std::vector<Part> parts);

  /// Puts it at a pose, which maps points of its own frame to the world's.
  void place(const Eigen::Isometry3d& T_world_body);

  const Eigen::Isometry3d& T_world_body() const { return T_world_body_; }
  const std::vector<Part>& parts() const { return parts_; }

  /// A box around it in the world.
  const Eigen::AlignedBox3d& bounds() const { return world_bounds_; }

  /// A box around it in its own frame.
  const Eigen::AlignedBox3d& ownBounds() const { return own_bounds_; }

  /// The first surface a ray of the world meets in `range`; false if there is none. A pixel is
  /// `pixel_m` wide at distance 1.
  bool intersect(const Ray& ray, const RayRange& range, double pixel_m, BodyHit& hit) const;

  /// The same for one part, with the ray in the frame of the body.
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

  double sunlit = 1.0;          ///< how much of the sun reaches it, from 0 to 1
  bool contact_shadow = false;  ///< the ground is dark below and close to it
  bool own_shade = false;       ///< so small that what stands around it can shade it as a whole

 private:
  std::vector<Part> parts_;
  Eigen::AlignedBox3d own_bounds_;
  Eigen::AlignedBox3d world_bounds_;
  Eigen::Isometry3d T_world_body_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_body_world_ = Eigen::Isometry3d::Identity();
};

/// Finds boxes in the way of a ray.
class BoxTest {
 public:
  explicit BoxTest(const Ray& ray)
      : origin_(ray.origin), inverse_direction_(ray.direction.cwiseInverse()) {}

  /// Whether the ray passes the box somewhere in `range`.
  bool passes(const RayRange& range, const Eigen::AlignedBox3d& box) const;

 private:
  Eigen::Vector3d origin_;
  Eigen::Vector3d inverse_direction_;
};

}  // namespace rotrocc
