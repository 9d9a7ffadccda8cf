#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "simulation/surfaces/surface_point.h"

namespace rotrocc {

/// Search interval of a ray: distances above `from` and below `to`.
struct RayRange {
  double from;
  double to;
};

struct ShapeHit {
  double distance;
  Eigen::Vector3d normal;  ///< of unit length, out of the shape
  int face;                ///< index of the smooth part of the surface
};

/// A solid in the frame of the body it belongs to: y points down, 0 is the ground.
class Shape {
 public:
  virtual ~Shape() = default;

  /// First intersection with the surface in `range`, from outside or inside; false if there is
  /// none.
  virtual bool intersect(const Ray& ray, const RayRange& range, ShapeHit& hit) const = 0;

  /// Bounding box.
  virtual Eigen::AlignedBox3d bounds() const = 0;
};

/// A box with planar cuts.
class ConvexSolid : public Shape {
 public:
  explicit ConvexSolid(const Eigen::AlignedBox3d& box) : box_(box) {}

  /// Removes everything beyond the plane through `point` with normal `outwards`.
  ConvexSolid& cut(const Eigen::Vector3d& outwards, const Eigen::Vector3d& point);

  bool intersect(const Ray& ray, const RayRange& range, ShapeHit& hit) const override;
  Eigen::AlignedBox3d bounds() const override { return box_; }

 private:
  struct Plane {
    Eigen::Vector3d normal;
    double offset;
  };

  struct Passage;
  bool passBox(const Ray& ray, Passage& passage) const;
  bool passCuts(const Ray& ray, Passage& passage) const;
  Eigen::Vector3d normalOf(int face) const;

  Eigen::AlignedBox3d box_;
  std::vector<Plane> cuts_;
};

/// The box between two corners.
std::shared_ptr<ConvexSolid> boxBetween(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

/// A closed cylinder along one of the axes of its body.
class Cylinder : public Shape {
 public:
  /// `axis` 0, 1 or 2 for x, y or z; it extends by `half_length` to both sides of the centre.
  Cylinder(int axis, const Eigen::Vector3d& centre, double radius, double half_length);

  bool intersect(const Ray& ray, const RayRange& range, ShapeHit& hit) const override;
  Eigen::AlignedBox3d bounds() const override;

 private:
  bool intersectSide(const Ray& ray, const RayRange& range, ShapeHit& hit) const;
  bool intersectLids(const Ray& ray, const RayRange& range, ShapeHit& hit) const;

  int axis_, u_, v_;
  Eigen::Vector3d centre_;
  double radius_, half_length_;
};

/// An ellipsoid with its axes along those of its body.
class Ellipsoid : public Shape {
 public:
  Ellipsoid(const Eigen::Vector3d& centre, const Eigen::Vector3d& half_axes)
      : centre_(centre), half_axes_(half_axes), scale_(half_axes.cwiseInverse()) {}

  bool intersect(const Ray& ray, const RayRange& range, ShapeHit& hit) const override;
  Eigen::AlignedBox3d bounds() const override;

 private:
  Eigen::Vector3d centre_;
  Eigen::Vector3d half_axes_;
  Eigen::Vector3d scale_;  // to the space in which it is a unit sphere
};

}  // namespace rotrocc
