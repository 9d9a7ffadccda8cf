#include "simulation/street/path.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/surfaces/coverage.h"

namespace rotrocc {

Path::Path(std::vector<Eigen::Vector3d> points) : points_(std::move(points)), stations_{0.0} {
  for (std::size_t i = 1; i < points_.size(); ++i) {
    stations_.push_back(stations_.back() + (points_[i] - points_[i - 1]).norm());
  }
}

Path::Piece Path::pieceAt(double station_m) const {
  const auto after = std::upper_bound(stations_.begin() + 1, stations_.end() - 1, station_m);
  const auto index = static_cast<std::size_t>(after - stations_.begin()) - 1;
  return {index, (station_m - stations_[index]) / (stations_[index + 1] - stations_[index])};
}

Eigen::Vector3d Path::tangent(std::size_t index) const {
  const std::size_t before = index == 0 ? 0 : index - 1;
  const std::size_t after = std::min(index + 1, points_.size() - 1);
  return (points_[after] - points_[before]) / (stations_[after] - stations_[before]);
}

Eigen::Vector3d Path::position(double station_m) const {
  if (station_m < 0.0 || station_m > length_m()) {
    const double end = station_m < 0.0 ? 0.0 : length_m();
    Eigen::Vector3d ahead = direction(end);
    ahead.y() = 0.0;
    return (station_m < 0.0 ? points_.front() : points_.back()) + (station_m - end) * ahead;
  }
  const auto [i, t] = pieceAt(station_m);
  const double length = stations_[i + 1] - stations_[i];
  const double ease = t * t * (3.0 - 2.0 * t);  // cubic Hermite basis
  return (1.0 - ease) * points_[i] + ease * points_[i + 1] +
         length * t * (1.0 - t) * ((1.0 - t) * tangent(i) - t * tangent(i + 1));
}

Eigen::Vector3d Path::direction(double station_m) const {
  const auto [i, t] = pieceAt(std::clamp(station_m, 0.0, length_m()));
  const Eigen::Vector3d chord = (points_[i + 1] - points_[i]) / (stations_[i + 1] - stations_[i]);
  const Eigen::Vector3d slope = 6.0 * t * (1.0 - t) * chord +
                                (1.0 - t) * (1.0 - 3.0 * t) * tangent(i) +
                                t * (3.0 * t - 2.0) * tangent(i + 1);
  return slope.normalized();
}

Eigen::Vector3d Path::right(double station_m) const {
  const Eigen::Vector3d ahead = direction(station_m);
  return Eigen::Vector3d(ahead.z(), 0.0, -ahead.x()).normalized();
}

double Path::heading_rad(double station_m) const {
  const Eigen::Vector3d ahead = direction(station_m);
  return std::atan2(ahead.x(), ahead.z());
}

Path Path::beside(double right_m, double beyond_m) const {
  constexpr double kSpacing_m = 0.5;
  const double length = beyond_m + length_m() + beyond_m;
  const int steps = std::max(1, static_cast<int>(std::ceil(length / kSpacing_m)));
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= steps; ++i) {
    const double station = -beyond_m + length * i / steps;
    const Eigen::Vector3d point = position(station) + right_m * right(station);
    // On the inner side of a bend with a radius below `right_m` the points would reverse.
    if (points.empty() || (point - points.back()).dot(direction(station)) > 0.1 * kSpacing_m) {
      points.push_back(point);
    }
  }
  return Path(std::move(points));
}

Path layPath(const std::vector<PathPiece>& pieces, const std::function<double(double)>& rise_m) {
  constexpr double kStep = 0.01;  // [m], of the integration
  constexpr int kStepsPerPoint = 25;
  std::vector<Eigen::Vector3d> points = {{0.0, -rise_m(0.0), 0.0}};
  Eigen::Vector2d at(0.0, 0.0);
  double heading = 0.0;
  double curvature = 0.0;
  double station = 0.0;
  int count = 0;
  for (const PathPiece& piece : pieces) {
    const int steps = static_cast<int>(std::lround(piece.length_m / kStep));
    for (int i = 0; i < steps; ++i) {
      const double bend =
          mix(curvature, piece.curvature_per_m, smoothStep(0.0, 1.0, (i + 0.5) / steps));
      const double middle = heading + 0.5 * kStep * bend;
      at += kStep * Eigen::Vector2d(std::sin(middle), std::cos(middle));
      heading += kStep * bend;
      station += kStep;
      if (++count % kStepsPerPoint == 0) points.emplace_back(at.x(), -rise_m(station), at.y());
    }
    curvature = piece.curvature_per_m;
  }
  return Path(std::move(points));
}

std::vector<PathPiece> turn(double angle_rad, double radius_m, double transition_m) {
  const double arc_m = std::abs(angle_rad) * radius_m - transition_m;  // each transition turns half
  const double curvature = std::copysign(1.0 / radius_m, angle_rad);
  return {{transition_m, curvature}, {arc_m, curvature}, {transition_m, 0.0}};
}

}  // namespace rotrocc
