#pragma once

#include <vector>

#include "check/rig_model.h"
#include "check/rig_report.h"
#include "check/windows.h"

namespace rotrocc {

/// Adds the bias of the disparities, its course, and a map of their errors: section disparities.
/// `applied_px`: which bias the odometry corrects. Returns whether a calibration can describe it:
/// not if it moves.
bool checkDisparities(const StereoCamera& camera,
                      const std::vector<PairSamples>& pairs,
                      const RigModel& model,
                      const Windows& windows,
                      double applied_px,
                      RigReport& report);

}  // namespace rotrocc
