#pragma once

#include "check/rig_model.h"
#include "check/rig_report.h"
#include "check/windows.h"

namespace rotrocc {

/// How rows of the right image differ from those of the left one.
struct RowDifferences {
  double rms_px = 0.0;
  Estimate unexplained_px;   ///< rms that the model does not explain: lenses leave some hundredths
  bool are_constant = true;  ///< over time
};

/// The subject of the finding that the rig moves.
constexpr char kRowsOverTime[] = "row differences over time";

/// Adds what explains the rows of the samples, to the sections rows and time, what is left, and
/// its course.
RowDifferences checkRows(const StereoCamera& camera,
                         const std::vector<PairSamples>& pairs,
                         const RigModel& model,
                         const Windows& windows,
                         RigReport& report);

}  // namespace rotrocc
