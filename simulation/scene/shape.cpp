#include "simulation/scene/shape.h"

#include <cmath>
#include <limits>

namespace rotrocc {
namespace {

bool isIn(const RayRange& range, double distance) {
  return distance > range.from && distance < range.to;
}

/// The smaller root in `range` of a t^2 + 2 b t + c = 0; false if there is none.
bool firstRoot(double a, double b, double c, const RayRange& range, double& root) {
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0 || a == 0.0) return false;
  const double far = -b + std::sqrt(discriminant);
  const double near = -b - std::sqrt(discriminant);
  for (const double numerator : {near, far}) {
    root = numerator / a;
    if (isIn(range, root)) return true;
  }
  return false;
}

class Cylinder : public Shape {
 public:
  Cylinder(int axis, const Eigen::Vector3d& center, double radius, double half_length)
      : axis_(axis),
        u_((axis + 1) % 3),
        v_((axis + 2) % 3),
        center_(center),
        radius_(radius),
        half_length_(half_length) {}

  bool intersect(const Ray& ray, const RayRange& range, ShapeHit& hit) const override {
    RayRange nearer = range;
    const bool side = intersectSide(ray, range, hit);
    if (side) nearer.to = hit.distance;
    return intersectLids(ray, nearer, hit) || side;
  }

  Eigen::AlignedBox3d bounds() const override {
    Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius_);
    reach[axis_] = half_length_;
    return {center_ - reach, center_ + reach};
  }

 private:
  bool intersectSide(const Ray& ray, const RayRange& range, ShapeHit& hit) const {
    const Eigen::Vector2d d(ray.direction[u_], ray.direction[v_]);
    const Eigen::Vector2d o(ray.origin[u_] - center_[u_], ray.origin[v_] - center_[v_]);
    RayRange rest = range;
    double distance = 0.0;
    while (
        firstRoot(d.squaredNorm(), d.dot(o), o.squaredNorm() - radius_ * radius_, rest, distance)) {
      const double height = ray.origin[axis_] + distance * ray.direction[axis_] - center_[axis_];
      if (std::abs(height) <= half_length_) {
        hit.distance = distance;
        hit.face = 0;
        hit.normal[axis_] = 0.0;
        hit.normal[u_] = (o.x() + distance * d.x()) / radius_;
        hit.normal[v_] = (o.y() + distance * d.y()) / radius_;
        return true;
      }
      rest.from = distance;
    }
    return false;
  }

  bool intersectLids(const Ray& ray, const RayRange& range, ShapeHit& hit) const {
    RayRange nearer = range;
    bool found = false;
    for (const double side : {-1.0, 1.0}) {
      const double lid = center_[axis_] + side * half_length_;
      const double distance = (lid - ray.origin[axis_]) / ray.direction[axis_];
      if (!isIn(nearer, distance)) continue;
      const double u = ray.origin[u_] + distance * ray.direction[u_] - center_[u_];
      const double v = ray.origin[v_] + distance * ray.direction[v_] - center_[v_];
      if (u * u + v * v > radius_ * radius_) continue;
      hit.distance = nearer.to = distance;
      hit.face = side < 0.0 ? 1 : 2;
      hit.normal = side * Eigen::Vector3d::Unit(axis_);
      found = true;
    }
    return found;
  }

  int axis_, u_, v_;
  Eigen::Vector3d center_;
  double radius_, half_length_;
};

class Ellipsoid : public Shape {
 public:
  Ellipsoid(const Eigen::Vector3d& center, const Eigen::Vector3d& half_axes)
      : center_(center), half_axes_(half_axes), scale_(half_axes.cwiseInverse()) {}

  bool intersect(const Ray& ray, const RayRange& range, ShapeHit& hit) const override {
    const Eigen::Vector3d o = (ray.origin - center_).cwiseProduct(scale_);
    const Eigen::Vector3d d = ray.direction.cwiseProduct(scale_);
    if (!firstRoot(d.squaredNorm(), d.dot(o), o.squaredNorm() - 1.0, range, hit.distance))
      return false;
    hit.normal = (o + hit.distance * d).cwiseProduct(scale_).normalized();
    hit.face = 0;
    return true;
  }

  Eigen::AlignedBox3d bounds() const override {
    return {center_ - half_axes_, center_ + half_axes_};
  }

 private:
  Eigen::Vector3d center_;
  Eigen::Vector3d half_axes_;
  Eigen::Vector3d scale_;  // to the space in which it is a unit sphere
};

}  // namespace

ConvexSolid& ConvexSolid::cut(const Eigen::Vector3d& outwards, const Eigen::Vector3d& point) {
  const Eigen::Vector3d normal = outwards.normalized();
  cuts_.push_back({normal, normal.dot(point)});
  return *this;
}

/// The section of a ray inside a convex solid, with entry and exit faces.
struct ConvexSolid::Passage {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  int entered = 0;
  int left = 0;

  void enterAt(double distance, int face) {
    if (!(distance > enter)) return;
    enter = distance;
    entered = face;
  }
  void leaveAt(double distance, int face) {
    if (!(distance < leave)) return;
    leave = distance;
    left = face;
  }
};

bool ConvexSolid::intersect(const Ray& ray, const RayRange& range, ShapeHit& hit) const {
  Passage passage;
  if (!passBox(ray, passage) || !passCuts(ray, passage)) return false;
  hit.distance = isIn(range, passage.enter) ? passage.enter : passage.leave;
  if (!isIn(range, hit.distance)) return false;
  hit.face = hit.distance == passage.enter ? passage.entered : passage.left;
  hit.normal = normalOf(hit.face);
  return true;
}

/// Faces 2 axis and 2 axis + 1 are those at the smallest and largest coordinate of the box.
bool ConvexSolid::passBox(const Ray& ray, Passage& passage) const {
  for (int axis = 0; axis < 3; ++axis) {
    const double inverse = 1.0 / ray.direction[axis];
    const double low = (box_.min()[axis] - ray.origin[axis]) * inverse;
    const double high = (box_.max()[axis] - ray.origin[axis]) * inverse;
    const bool rises = inverse > 0.0;
    passage.enterAt(rises ? low : high, 2 * axis + (rises ? 0 : 1));
    passage.leaveAt(rises ? high : low, 2 * axis + (rises ? 1 : 0));
  }
  return passage.enter < passage.leave;
}

bool ConvexSolid::passCuts(const Ray& ray, Passage& passage) const {
  int face = 6;
  for (const Plane& plane : cuts_) {
    const double approach = plane.normal.dot(ray.direction);
    const double distance = (plane.offset - plane.normal.dot(ray.origin)) / approach;
    if (approach < 0.0) {
      passage.enterAt(distance, face);
    } else {
      passage.leaveAt(distance, face);
    }
    if (passage.enter >= passage.leave) return false;
    ++face;
  }
  return true;
}

Eigen::Vector3d ConvexSolid::normalOf(int face) const {
  if (face >= 6) return cuts_[static_cast<std::size_t>(face - 6)].normal;
  return (face % 2 == 0 ? -1.0 : 1.0) * Eigen::Vector3d::Unit(face / 2);
}

std::shared_ptr<ConvexSolid> boxBetween(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return std::make_shared<ConvexSolid>(Eigen::AlignedBox3d(low, high));
}

std::shared_ptr<const Shape> cylinder(int axis,
                                      const Eigen::Vector3d& center,
                                      double radius,
                                      double half_length) {
  return std::make_shared<Cylinder>(axis, center, radius, half_length);
}

std::shared_ptr<const Shape> ellipsoid(const Eigen::Vector3d& center,
                                       const Eigen::Vector3d& half_axes) {
  return std::make_shared<Ellipsoid>(center, half_axes);
}

}  // namespace rotrocc
