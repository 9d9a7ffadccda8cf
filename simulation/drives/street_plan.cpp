#include "simulation/drives/street_plan.h"

#include <cmath>
#include <unordered_map>
#include <utility>

namespace rotrocc {
namespace {

constexpr double kPointSpacing_m = 0.5;
constexpr double kNeighbour_m = 40.0;  // least distance along a path between two passages
constexpr double kMinLength_m = 10.0;  // of a street

/// Points with their stations, indexed by position.
class PassedPoints {
 public:
  explicit PassedPoints(double reach_m) : reach_m_(reach_m) {}

  void add(const Eigen::Vector3d& point, double station_m) {
    cells_[key(cellOf(point.x()), cellOf(point.z()))].push_back({point, station_m});
  }

  /// Whether an earlier point, by at least kNeighbour_m, is in reach.
  bool cameBy(const Eigen::Vector3d& point, double station_m) const {
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dz = -1; dz <= 1; ++dz) {
        const auto cell = cells_.find(key(cellOf(point.x()) + dx, cellOf(point.z()) + dz));
        if (cell == cells_.end()) continue;
        for (const auto& [other, other_station] : cell->second) {
          if (station_m - other_station < kNeighbour_m) continue;
          if (std::hypot(point.x() - other.x(), point.z() - other.z()) < reach_m_) return true;
        }
      }
    }
    return false;
  }

 private:
  std::int64_t cellOf(double value) const {
    return static_cast<std::int64_t>(std::floor(value / reach_m_));
  }
  static std::int64_t key(std::int64_t column, std::int64_t row) { return column * 1000003 + row; }

  double reach_m_;
  std::unordered_map<std::int64_t, std::vector<std::pair<Eigen::Vector3d, double>>> cells_;
};

}  // namespace

std::vector<Path> streetsAlong(const Path& path,
                               double right_m,
                               double beyond_m,
                               double same_street_m) {
  const Path line = path.beside(right_m, kPointSpacing_m, beyond_m, beyond_m);
  std::vector<Path> streets;
  PassedPoints passed(same_street_m);
  std::vector<Eigen::Vector3d> points;
  const auto finish = [&] {
    if (static_cast<double>(points.size()) * kPointSpacing_m >= kMinLength_m)
      streets.emplace_back(points);
    points.clear();
  };
  for (double station = 0.0; station <= line.length_m(); station += kPointSpacing_m) {
    const Eigen::Vector3d point = line.position(station);
    if (passed.cameBy(point, station)) {
      finish();
      continue;
    }
    passed.add(point, station);
    points.push_back(point);
  }
  finish();
  return streets;
}

}  // namespace rotrocc
