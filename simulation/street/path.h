#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

namespace rotrocc {

/// A smooth curve, parametrized by arc length (station): x right and z forward at the start, y
/// down.
class Path {
 public:
  /// A Catmull-Rom spline through the points: at least two, of which no neighbors coincide.
  explicit Path(std::vector<Eigen::Vector3d> points);

  double length_m() const { return stations_.back(); }

  /// Position at `station_m`; beyond the ends the path continues straight and level.
  Eigen::Vector3d position(double station_m) const;
  Eigen::Vector3d direction(double station_m) const;
  Eigen::Vector3d right(double station_m) const;
  double heading_rad(double station_m) const;  ///< 0 along z, positive to the right

  /// The path `right_m` beside this one, with a point every 0.5 m of this one's stations, also for
  /// `beyond_m` before its start and after its end.
  Path beside(double right_m, double beyond_m = 0.0) const;

 private:
  struct Piece {
    std::size_t index;
    double t;  // 0 ... 1 between points index and index + 1
  };
  Piece pieceAt(double station_m) const;
  Eigen::Vector3d tangent(std::size_t index) const;

  std::vector<Eigen::Vector3d> points_;
  std::vector<double> stations_;
};

/// A section of a road: the curvature changes smoothly from that of the previous one to its own.
struct PathPiece {
  double length_m;
  double curvature_per_m;  ///< at its end; positive to the right
};

/// The path of these pieces from the origin along z, lifted by hills by `rise_m(station)`.
Path layPath(const std::vector<PathPiece>& pieces, const std::function<double(double)>& rise_m);

/// A turn by `angle_rad` (positive to the right), at least by what its transitions turn: over
/// `transition_m` the curvature grows to 1 / radius and decreases again at the end.
std::vector<PathPiece> turn(double angle_rad, double radius_m, double transition_m);

}  // namespace rotrocc
