#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "rotrocc/trajectory.h"

namespace rotrocc {

/// The first pose that is not before a stamp. Stamps must increase.
Trajectory::const_iterator firstFrom(const Trajectory& trajectory, std::int64_t stamp_ns);

/// The pose at a stamp, between the poses before and after it if these are at most `max_gap_ns`
/// apart; none outside of the trajectory and in longer gaps. Stamps must increase.
std::optional<Eigen::Isometry3d> poseAt(const Trajectory& trajectory,
                                        std::int64_t stamp_ns,
                                        std::int64_t max_gap_ns);

/// The poses at those stamps at which there are some, with gaps of up to 0.1 s: recorded truths
/// have 10 Hz (KITTI) to 200 Hz (EuRoC).
Trajectory samplePoses(const Trajectory& trajectory, const std::vector<std::int64_t>& stamps_ns);

}  // namespace rotrocc
