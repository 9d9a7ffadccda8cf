#include "rotrocc/trajectory.h"

#include <algorithm>

namespace rotrocc {

Trajectory::const_iterator firstFrom(const Trajectory& trajectory, std::int64_t stamp_ns) {
  const auto is_before = [](const StampedPose& pose, std::int64_t ns) {
    return pose.stamp_ns < ns;
  };
  return std::lower_bound(trajectory.begin(), trajectory.end(), stamp_ns, is_before);
}

std::optional<Eigen::Isometry3d> poseAt(const Trajectory& trajectory,
                                        std::int64_t stamp_ns,
                                        std::int64_t max_gap_ns) {
  const auto after = firstFrom(trajectory, stamp_ns);
  if (after == trajectory.end()) return std::nullopt;
  if (after->stamp_ns == stamp_ns) return after->T_world_body;
  if (after == trajectory.begin()) return std::nullopt;
  const StampedPose& before = *(after - 1);
  if (after->stamp_ns - before.stamp_ns > max_gap_ns) return std::nullopt;

  const double share = static_cast<double>(stamp_ns - before.stamp_ns) /
                       static_cast<double>(after->stamp_ns - before.stamp_ns);
  const Eigen::Quaterniond from(before.T_world_body.linear());
  const Eigen::Quaterniond to(after->T_world_body.linear());
  Eigen::Isometry3d pose(from.slerp(share, to));
  pose.translation() =
      (1.0 - share) * before.T_world_body.translation() + share * after->T_world_body.translation();
  return pose;
}

Trajectory samplePoses(const Trajectory& trajectory, const std::vector<std::int64_t>& stamps_ns) {
  constexpr std::int64_t kMaxGap_ns = 100'000'000;
  Trajectory samples;
  for (const std::int64_t stamp_ns : stamps_ns) {
    if (const auto pose = poseAt(trajectory, stamp_ns, kMaxGap_ns)) {
      samples.push_back({stamp_ns, *pose});
    }
  }
  return samples;
}

}  // namespace rotrocc
