#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace rotrocc {

/// Camera rays have unit depth, so that the distance in units of `direction` is the depth [m].
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;

  Eigen::Vector3d at(double distance) const { return origin + distance * direction; }
};

/// Change of a ray's direction per pixel.
struct PixelSpread {
  Eigen::Vector3d per_column;
  Eigen::Vector3d per_row;
};

/// Intersection of a ray with a surface, and the offsets of the neighboring pixels on it [m].
struct SurfacePoint {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;  ///< of unit length, towards the viewer
  Eigen::Vector3d per_column;
  Eigen::Vector3d per_row;
};

/// The same in two coordinates along the surface [m].
struct TexturePoint {
  Eigen::Vector2d at;
  Eigen::Vector2d per_column;
  Eigen::Vector2d per_row;

  /// The width of the pixel along the first or second coordinate [m].
  double width(int axis) const {
    return std::sqrt(per_column[axis] * per_column[axis] + per_row[axis] * per_row[axis]);
  }

  /// The same, large enough to divide by.
  double pixelWidth() const { return std::max(width(0), 1e-4); }
  double pixelHeight() const { return std::max(width(1), 1e-4); }
};

/// The point on a texture scaled by 1 / `factor`.
inline TexturePoint scaled(const TexturePoint& point, double factor) {
  return {factor * point.at, factor * point.per_column, factor * point.per_row};
}

/// Projects a surface point on the directions `u` and `v` of unit length.
inline TexturePoint project(const SurfacePoint& point,
                            const Eigen::Vector3d& u,
                            const Eigen::Vector3d& v) {
  return {{u.dot(point.position), v.dot(point.position)},
          {u.dot(point.per_column), v.dot(point.per_column)},
          {u.dot(point.per_row), v.dot(point.per_row)}};
}

/// The point at `distance` along `ray`, on a surface with this normal.
inline SurfacePoint surfacePoint(const Ray& ray,
                                 const PixelSpread& spread,
                                 double distance,
                                 const Eigen::Vector3d& normal) {
  // A neighboring ray hits the tangent plane at another distance.
  const double slant = distance / normal.dot(ray.direction);
  const auto shift = [&](const Eigen::Vector3d& change) -> Eigen::Vector3d {
    return distance * change - slant * normal.dot(change) * ray.direction;
  };
  return {ray.at(distance), normal, shift(spread.per_column), shift(spread.per_row)};
}

}  // namespace rotrocc
