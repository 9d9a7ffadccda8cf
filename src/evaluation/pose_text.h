#pragma once

#include <ostream>

#include "rotrocc/trajectory.h"

namespace rotrocc {

/// Prepares a stream for writePose(): digits, and no decimal comma of the locale.
void preparePoseText(std::ostream& out);

/// Writes the line of a pose, with its end. KITTI lines have 10 significant digits, TUM lines 9
/// decimals.
void writePose(const StampedPose& pose, TrajectoryFormat format, std::ostream& out);

}  // namespace rotrocc
