#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "simulation/street/path.h"

namespace rotrocc {

/// The path through the positions of a motion. Steps of less than 1 m are left out: at a standstill
/// they are noise. Throws std::invalid_argument if all positions are within 1 m.
Path pathThrough(const std::vector<Eigen::Vector3d>& positions,
                 const std::optional<Eigen::Vector3d>& view = {});

/// The station on that path of each position; it never decreases.
std::vector<double> stationsAlong(const std::vector<Eigen::Vector3d>& positions);

}  // namespace rotrocc
