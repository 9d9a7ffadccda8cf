#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "rotrocc/rigid_motion.h"
#include "simulation/drives/drive.h"

namespace rotrocc {
namespace {

constexpr double kMinStep_m =
    1.0;  // between points of the path; shorter steps are noise at standstill

Path pathOf(const Trajectory& trajectory) {
  std::vector<Eigen::Vector3d> points;
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector3d position = pose.T_world_body.translation();
    if (points.empty() || (position - points.back()).norm() >= kMinStep_m)
      points.push_back(position);
  }
  if (points.size() < 2) {
    throw std::invalid_argument("the " + std::to_string(trajectory.size()) +
                                " poses stay within 1 m: give a drive that goes somewhere");
  }
  return Path(std::move(points));
}

/// Station of each pose.
std::vector<double> stationsOf(const Trajectory& trajectory) {
  std::vector<double> stations;
  Eigen::Vector3d last_point = trajectory.front().T_world_body.translation();
  double last_station = 0.0;
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector3d position = pose.T_world_body.translation();
    const double beyond = (position - last_point).norm();
    const double station = last_station + beyond;
    stations.push_back(stations.empty() ? station : std::max(station, stations.back()));
    if (beyond < kMinStep_m) continue;
    last_point = position;
    last_station = station;
  }
  return stations;
}

}  // namespace

RecordedDrive::RecordedDrive(Trajectory trajectory)
    : trajectory_(std::move(trajectory)),
      path_(pathOf(trajectory_)),
      stations_m_(stationsOf(trajectory_)) {
  for (const StampedPose& pose : trajectory_) {
    times_s_.push_back(1e-9 * static_cast<double>(pose.stamp_ns - trajectory_.front().stamp_ns));
  }
}

std::size_t RecordedDrive::intervalAt(double time_s) const {
  const auto after = std::upper_bound(times_s_.begin() + 1, times_s_.end() - 1, time_s);
  return static_cast<std::size_t>(after - times_s_.begin()) - 1;
}

double RecordedDrive::station_m(double time_s) const {
  const std::size_t i = intervalAt(time_s);
  const double t = (time_s - times_s_[i]) / (times_s_[i + 1] - times_s_[i]);
  return stations_m_[i] + t * (stations_m_[i + 1] - stations_m_[i]);
}

Eigen::Isometry3d RecordedDrive::pose(double time_s) const {
  const double time = std::clamp(time_s, 0.0, duration_s());
  const std::size_t i = intervalAt(time);
  const double length_s = times_s_[i + 1] - times_s_[i];
  const double t = (time - times_s_[i]) / length_s;
  const auto position = [&](std::size_t k) -> Eigen::Vector3d {
    return trajectory_[k].T_world_body.translation();
  };
  const auto velocity = [&](std::size_t k) -> Eigen::Vector3d {
    const std::size_t before = k == 0 ? 0 : k - 1;
    const std::size_t after = std::min(k + 1, trajectory_.size() - 1);
    return (position(after) - position(before)) / (times_s_[after] - times_s_[before]);
  };
  const double ease = t * t * (3.0 - 2.0 * t);  // cubic Hermite basis
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = (1.0 - ease) * position(i) + ease * position(i + 1) +
                       length_s * t * (1.0 - t) * ((1.0 - t) * velocity(i) - t * velocity(i + 1));
  const auto orientation = [&](std::size_t k) -> Eigen::Matrix3d {
    return trajectory_[k].T_world_body.linear();
  };
  // Angular velocities in axes of pose k; the rotation since pose i is a cubic rotation vector.
  const auto rate = [&](std::size_t k) -> Eigen::Vector3d {
    const std::size_t before = k == 0 ? 0 : k - 1;
    const std::size_t after = std::min(k + 1, trajectory_.size() - 1);
    return logRotation(orientation(before).transpose() * orientation(after)) /
           (times_s_[after] - times_s_[before]);
  };
  const Eigen::Vector3d turn = logRotation(orientation(i).transpose() * orientation(i + 1));
  const Eigen::Vector3d end_slope = leftJacobian(-turn).inverse() * rate(i + 1);
  pose.linear() =
      orientation(i) *
      expRotation(ease * turn + length_s * t * (1.0 - t) * ((1.0 - t) * rate(i) - t * end_slope));
  return pose;
}

}  // namespace rotrocc
