#include "simulation/drives/travelled_way.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace rotrocc {
namespace {

constexpr double kMinStep_m = 1.0;

}  // namespace

Path pathThrough(const std::vector<Eigen::Vector3d>& positions,
                 const std::optional<Eigen::Vector3d>& view) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& position : positions) {
    if (points.empty() || (position - points.back()).norm() >= kMinStep_m)
      points.push_back(position);
  }
  if (points.size() < 2 && view) points.push_back(points.front() + *view);
  if (points.size() < 2) {
    throw std::invalid_argument("the " + std::to_string(positions.size()) +
                                " poses stay within 1 m: give a drive that goes somewhere");
  }
  return Path(std::move(points));
}

std::vector<double> stationsAlong(const std::vector<Eigen::Vector3d>& positions) {
  std::vector<double> stations;
  Eigen::Vector3d last_point = positions.front();
  double last_station = 0.0;
  for (const Eigen::Vector3d& position : positions) {
    const double beyond = (position - last_point).norm();
    const double station = last_station + beyond;
    stations.push_back(stations.empty() ? station : std::max(station, stations.back()));
    if (beyond < kMinStep_m) continue;
    last_point = position;
    last_station = station;
  }
  return stations;
}

}  // namespace rotrocc
