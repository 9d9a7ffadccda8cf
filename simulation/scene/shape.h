#pragma once

#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "simulation/surfaces/surface_point.h"

namespace rotrocc {

/// Distances along a ray, above `from` and below `to`.
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

  /// First intersection with the surface in `range`, from outside or inside; false if none.
  virtual bool intersect(const Ray& ray, const RayRange& range, ShapeHit& hit) const = 0;

  virtual Eigen::AlignedBox3d bounds() const = 0;
};

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

std::shared_ptr<ConvexSolid> boxBetween(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

/// A closed cylinder along one of the axes of its body, 0, 1 or 2 for x, y or z; it extends by
/// `half_length` to both sides of the center.
std::shared_ptr<const Shape> cylinder(int axis,
                                      const Eigen::Vector3d& center,
                                      double radius,
                                      double half_length);

/// An ellipsoid with its axes along those of its body.
std::shared_ptr<const Shape> ellipsoid(const Eigen::Vector3d& center,
                                       const Eigen::Vector3d& half_axes);

}  // namespace rotrocc
