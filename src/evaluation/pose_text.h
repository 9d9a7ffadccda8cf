#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Geometry>

#include "evaluation/text_file.h"

namespace rotrocc {

/// Why a matrix, printed with four digits or more, is no rotation; empty if it is one.
std::string whyNoRotation(const Eigen::Matrix3d& matrix);

/// The pose of a position [m] in the words 1 to 3 and a quaternion in the words 4 to 7, w last or
/// first. Throws std::runtime_error if they are no numbers, or the quaternion has not the length 1.
Eigen::Isometry3d quaternionPose(const TextLine& line, bool w_first);

/// Throws std::runtime_error unless `stamp_ns`, of the first word, is later than the one before it.
void requireLater(const TextLine& line, std::int64_t stamp_ns, std::int64_t previous_ns);

}  // namespace rotrocc
