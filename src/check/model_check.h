#pragma once

#include <vector>

#include "check/rig_model.h"
#include "check/rig_report.h"
#include "check/windows.h"

namespace rotrocc {

/// What a model leaves of the differences between left and right images.
struct ModelRest {
  double rows_px = 0.0;     ///< row differences as they are, rms over the image
  Estimate unexplained_px;  ///< of these by no cause: lenses leave some hundredths
  bool is_constant = true;  ///< rows and bias, over time
  /// Whether most of the rows are explained: wrong matches have no cause in common.
  bool isMostlyExplained() const {
    return unexplained_px.value + 3.0 * unexplained_px.sigma < 0.5 * rows_px;
  }
};

/// The subject of the finding that the rig moves.
constexpr char kRowsOverTime[] = "row differences over time";

/// Adds what the causes of a model cost, what it leaves of the rows, and whether rows and bias
/// move: sections rows, disparities and time. `applied_px`: which bias the odometry corrects.
ModelRest checkModel(const StereoCamera& camera,
                     const std::vector<PairSamples>& pairs,
                     const RigModel& model,
                     const Windows& windows,
                     double applied_px,
                     RigReport& report);

}  // namespace rotrocc
