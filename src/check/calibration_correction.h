#pragma once

#include <optional>
#include <string>

#include "bags/recording.h"
#include "check/rig_check.h"
#include "rectification/stereo_calibration.h"

namespace rotrocc {

/// Checks a recording by corrected calibrations, until nothing that they correct must be fixed, at
/// most four times. The result has the last one in its measures. None, with the reason in
/// `why_not`, if nothing must be fixed, the images do not show what to correct, pairs or
/// rectification are wrong, the rig moves, windows that it is not from do not fit better, or more
/// pairs would be lost.
std::optional<CheckedRig> findCorrection(Recording& recording,
                                         const RigCheckOptions& options,
                                         const RigMeasures& before,
                                         std::string& why_not);

/// Writes left.yaml and right.yaml, in the format of camera_calibration. Throws std::runtime_error
/// if they cannot be written.
void writeCalibration(const StereoCalibration& calibration, const std::string& directory);

}  // namespace rotrocc
