#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/to_seconds.h"
#include "rotrocc/rigid_motion.h"
#include "simulation/drives/drive.h"

namespace rotrocc {
namespace {

constexpr double kMinStep_m = 1.0;  // shorter ones are left out: at a standstill they are noise

/// Throws std::invalid_argument if the positions stay within kMinStep_m.
Path pathThrough(const Trajectory& trajectory) {
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

}  // namespace

RecordedDrive::RecordedDrive(Trajectory trajectory)
    : Drive(pathThrough(trajectory)), trajectory_(std::move(trajectory)) {
  Eigen::Vector3d last_point = trajectory_.front().T_world_body.translation();
  double last_station = 0.0;
  for (const StampedPose& pose : trajectory_) {
    times_s_.push_back(toSeconds(pose.stamp_ns - trajectory_.front().stamp_ns));
    const double beyond = (pose.T_world_body.translation() - last_point).norm();
    const double before = stations_m_.empty() ? 0.0 : stations_m_.back();
    stations_m_.push_back(std::max(last_station + beyond, before));  // it never decreases
    if (beyond < kMinStep_m) continue;
    last_station += beyond;
    last_point = pose.T_world_body.translation();
  }
  duration_s_ = times_s_.back();
}

RecordedDrive::Place RecordedDrive::placeAt(double time_s) const {
  const auto after = std::upper_bound(times_s_.begin() + 1, times_s_.end() - 1, time_s);
  const auto index = static_cast<std::size_t>(after - times_s_.begin()) - 1;
  return {index, (time_s - times_s_[index]) / (times_s_[index + 1] - times_s_[index])};
}

double RecordedDrive::station_m(double time_s) const {
  const auto [i, t] = placeAt(time_s);
  return stations_m_[i] + t * (stations_m_[i + 1] - stations_m_[i]);
}

Eigen::Isometry3d RecordedDrive::pose(double time_s) const {
  const auto [i, t] = placeAt(time_s);
  const Eigen::Isometry3d& from = trajectory_[i].T_world_body;
  const Eigen::Isometry3d& to = trajectory_[i + 1].T_world_body;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = (1.0 - t) * from.translation() + t * to.translation();
  pose.linear() =
      from.linear() * expRotation(t * logRotation(from.linear().transpose() * to.linear()));
  return pose;
}

}  // namespace rotrocc
