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

std::vector<Eigen::Vector3d> positionsOf(const Trajectory& trajectory) {
  std::vector<Eigen::Vector3d> positions;
  for (const StampedPose& pose : trajectory) positions.push_back(pose.T_world_body.translation());
  return positions;
}

/// A level direction of unit length, along which the street of a motion on the spot is built.
Eigen::Vector3d levelView(const Trajectory& trajectory) {
  constexpr double kLeastExtent_m = 0.01;
  constexpr double kLeastLevel = 0.1;  // else the view is straight up or down
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& position : positionsOf(trajectory)) box.extend(position);
  if (trajectory.size() < 2 || box.diagonal().norm() < kLeastExtent_m) {
    throw std::invalid_argument("the " + std::to_string(trajectory.size()) +
                                " poses stay within 1 cm: give a drive that goes somewhere");
  }
  Eigen::Vector3d view = trajectory.front().T_world_body.linear().col(2);
  view.y() = 0.0;
  return view.norm() > kLeastLevel ? view.normalized() : Eigen::Vector3d(Eigen::Vector3d::UnitZ());
}

/// The path through the positions, or along `view` if they stay within kMinStep_m.
Path pathThrough(const std::vector<Eigen::Vector3d>& positions, const Eigen::Vector3d& view) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& position : positions) {
    if (points.empty() || (position - points.back()).norm() >= kMinStep_m)
      points.push_back(position);
  }
  if (points.size() < 2) points.push_back(points.front() + view);
  return Path(std::move(points));
}

/// The station on that path of each position; it never decreases.
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

}  // namespace

RecordedDrive::RecordedDrive(Trajectory trajectory)
    : trajectory_(std::move(trajectory)),
      path_(pathThrough(positionsOf(trajectory_), levelView(trajectory_))),
      stations_m_(stationsAlong(positionsOf(trajectory_))) {
  for (const StampedPose& pose : trajectory_) {
    times_s_.push_back(toSeconds(pose.stamp_ns - trajectory_.front().stamp_ns));
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
  Eigen::Isometry3d pose = between(time);
  const double beyond_s = time_s - time;
  if (beyond_s == 0.0) return pose;
  const std::size_t end = beyond_s < 0.0 ? 0 : trajectory_.size() - 1;
  pose.translation() += beyond_s * velocity(end);
  pose.linear() = pose.linear() * expRotation(beyond_s * rate(end));
  return pose;
}

/// The pose at a time of the recording: a cubic Hermite spline, for the rotation that of its vector
/// since the pose before.
Eigen::Isometry3d RecordedDrive::between(double time_s) const {
  const std::size_t i = intervalAt(time_s);
  const double length_s = times_s_[i + 1] - times_s_[i];
  const double t = (time_s - times_s_[i]) / length_s;
  const double ease = t * t * (3.0 - 2.0 * t);
  const Eigen::Isometry3d& from = trajectory_[i].T_world_body;
  const Eigen::Isometry3d& to = trajectory_[i + 1].T_world_body;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = (1.0 - ease) * from.translation() + ease * to.translation() +
                       length_s * t * (1.0 - t) * ((1.0 - t) * velocity(i) - t * velocity(i + 1));
  const Eigen::Vector3d turn = logRotation(from.linear().transpose() * to.linear());
  const Eigen::Vector3d end_slope = leftJacobian(-turn).inverse() * rate(i + 1);
  pose.linear() =
      from.linear() *
      expRotation(ease * turn + length_s * t * (1.0 - t) * ((1.0 - t) * rate(i) - t * end_slope));
  return pose;
}

RecordedDrive::Difference RecordedDrive::differenceAt(std::size_t pose) const {
  const std::size_t before = pose == 0 ? 0 : pose - 1;
  const std::size_t after = std::min(pose + 1, trajectory_.size() - 1);
  return {trajectory_[before].T_world_body,
          trajectory_[after].T_world_body,
          times_s_[after] - times_s_[before]};
}

/// In the world.
Eigen::Vector3d RecordedDrive::velocity(std::size_t pose) const {
  const Difference difference = differenceAt(pose);
  return (difference.after.translation() - difference.before.translation()) / difference.length_s;
}

/// In axes of the pose.
Eigen::Vector3d RecordedDrive::rate(std::size_t pose) const {
  const Difference difference = differenceAt(pose);
  return logRotation(difference.before.linear().transpose() * difference.after.linear()) /
         difference.length_s;
}

}  // namespace rotrocc
