#include "shape.h"

#include <cmath>

namespace rotrocc {
namespace {

bool isIn(const RayRange& range, double distance) {
  return distance > range.from && distance < range.to;
}

/// The nearer root in `range` of a t^2 + 2 b t + c = 0; false if there is none.
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

}  // namespace

ConvexSolid::ConvexSolid(const Eigen::AlignedBox3d& box) : box_(box) {
  for (int axis = 0; axis < 3; ++axis) {
    planes_.push_back({Eigen::Vector3d::Unit(axis), box.max()[axis]});
    planes_.push_back({-Eigen::Vector3d::Unit(axis), -box.min()[axis]});
  }
}

ConvexSolid& ConvexSolid::cut(const Eigen::Vector3d& outwards, const Eigen::Vector3d& point) {
  const Eigen::Vector3d normal = outwards.normalized();
  planes_.push_back({normal, normal.dot(point)});
  return *this;
}

bool ConvexSolid::intersect(const Ray& ray, const RayRange& range, ShapeHit& hit) const {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  int entered = 0;
  int left = 0;
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const double approach = planes_[i].normal.dot(ray.direction);
    const double height = planes_[i].normal.dot(ray.origin) - planes_[i].offset;
    if (approach == 0.0) {
      if (height > 0.0) return false;
      continue;
    }
    const double distance = -height / approach;
    if (approach < 0.0) {
      if (distance > enter) {
        enter = distance;
        entered = static_cast<int>(i);
      }
    } else if (distance < leave) {
      leave = distance;
      left = static_cast<int>(i);
    }
    if (enter >= leave) return false;
  }
  hit.distance = isIn(range, enter) ? enter : leave;
  if (!isIn(range, hit.distance)) return false;
  hit.face = hit.distance == enter ? entered : left;
  hit.normal = planes_[hit.face].normal;
  return true;
}

Cylinder::Cylinder(int axis, const Eigen::Vector3d& centre, double radius, double half_length)
    : axis_(axis),
      u_((axis + 1) % 3),
      v_((axis + 2) % 3),
      centre_(centre),
      radius_(radius),
      half_length_(half_length) {}

bool Cylinder::intersect(const Ray& ray, const RayRange& range, ShapeHit& hit) const {
  RayRange nearer = range;
  const bool side = intersectSide(ray, range, hit);
  if (side) nearer.to = hit.distance;
  return intersectLids(ray, nearer, hit) || side;
}

bool Cylinder::intersectSide(const Ray& ray, const RayRange& range, ShapeHit& hit) const {
  const Eigen::Vector2d d(ray.direction[u_], ray.direction[v_]);
  const Eigen::Vector2d o(ray.origin[u_] - centre_[u_], ray.origin[v_] - centre_[v_]);
  RayRange rest = range;
  double distance = 0.0;
  while (
      firstRoot(d.squaredNorm(), d.dot(o), o.squaredNorm() - radius_ * radius_, rest, distance)) {
    const double height = ray.origin[axis_] + distance * ray.direction[axis_] - centre_[axis_];
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

bool Cylinder::intersectLids(const Ray& ray, const RayRange& range, ShapeHit& hit) const {
  RayRange nearer = range;
  bool found = false;
  for (const double side : {-1.0, 1.0}) {
    const double lid = centre_[axis_] + side * half_length_;
    const double distance = (lid - ray.origin[axis_]) / ray.direction[axis_];
    if (!isIn(nearer, distance)) continue;
    const double u = ray.origin[u_] + distance * ray.direction[u_] - centre_[u_];
    const double v = ray.origin[v_] + distance * ray.direction[v_] - centre_[v_];
    if (u * u + v * v > radius_ * radius_) continue;
    hit.distance = nearer.to = distance;
    hit.face = side < 0.0 ? 1 : 2;
    hit.normal = side * Eigen::Vector3d::Unit(axis_);
    found = true;
  }
  return found;
}

Eigen::AlignedBox3d Cylinder::bounds() const {
  Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius_);
  reach[axis_] = half_length_;
  return {centre_ - reach, centre_ + reach};
}

bool Ellipsoid::intersect(const Ray& ray, const RayRange& range, ShapeHit& hit) const {
  const Eigen::Vector3d o = (ray.origin - centre_).cwiseProduct(scale_);
  const Eigen::Vector3d d = ray.direction.cwiseProduct(scale_);
  if (!firstRoot(d.squaredNorm(), d.dot(o), o.squaredNorm() - 1.0, range, hit.distance))
    return false;
  hit.normal = (o + hit.distance * d).cwiseProduct(scale_).normalized();
  hit.face = 0;
  return true;
}

Eigen::AlignedBox3d Ellipsoid::bounds() const {
  return {centre_ - half_axes_, centre_ + half_axes_};
}

}  // namespace rotrocc
