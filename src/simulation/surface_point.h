#pragma once

#include <cmath>

#include <Eigen/Core>

namespace rotrocc {

/// A line of sight. `direction` is not normalized: rays of a camera have unit depth, so that the
/// distance along the ray, in units of its length, is the depth [m].
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;

  Eigen::Vector3d at(double distance) const { return origin + distance * direction; }
};

/// How far the direction of a ray moves from a pixel to the next.
struct PixelSpread {
  Eigen::Vector3d per_column;
  Eigen::Vector3d per_row;
};

/// Where a ray meets a surface, and how far on it from there the neighbouring pixels look [m].
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
};

/// The point of a texture that is enlarged by 1 / `factor`.
inline TexturePoint scaled(const TexturePoint& point, double factor) {
  return {factor * point.at, factor * point.per_column, factor * point.per_row};
}

/// Takes two coordinates of a surface point: `u` and `v` are directions of unit length.
inline TexturePoint project(const SurfacePoint& point,
                            const Eigen::Vector3d& u,
                            const Eigen::Vector3d& v) {
  return {{u.dot(point.position), v.dot(point.position)},
          {u.dot(point.per_column), v.dot(point.per_column)},
          {u.dot(point.per_row), v.dot(point.per_row)}};
}

/// The point where `ray` has the distance `distance`, on a surface with this normal.
inline SurfacePoint surfacePoint(const Ray& ray,
                                 const PixelSpread& spread,
                                 double distance,
                                 const Eigen::Vector3d& normal) {
  // A neighbour's ray meets the tangent plane nearer or farther than this one's.
  const double slant = distance / normal.dot(ray.direction);
  const auto shift = [&](const Eigen::Vector3d& change) -> Eigen::Vector3d {
    return distance * change - slant * normal.dot(change) * ray.direction;
  };
  return {ray.at(distance), normal, shift(spread.per_column), shift(spread.per_row)};
}

}  // namespace rotrocc
