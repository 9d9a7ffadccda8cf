#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "bags/recording.h"
#include "check/model_check.h"
#include "check/rig_model.h"
#include "check/rig_report.h"
#include "rectification/stereo_calibration.h"
#include "rotrocc/parameters.h"

namespace rotrocc {

struct RigCheckOptions {
  Parameters parameters;
  std::string rectify = "auto";  ///< see RecordedPairs
  /// In place of that of the recording, see RecordedPairs; null: none.
  std::shared_ptr<const StereoCalibration> calibration;
  std::optional<GyroRecording> gyroscope;  ///< to compare with
  std::function<void()> on_pair = [] {};   ///< after each pair
};

/// Two of the Windows of five pairs. With fewer motions that move features, a report says what it
/// has measured, but not what to do.
constexpr int kLeastMotions = 10;

/// What a calibration can correct.
struct RigMeasures {
  StereoCalibration calibration;  ///< that the pairs were taken by
  RigModel model;
  ModelRest rest;
  bool is_known = false;  ///< whether pairs and rectification are right, so that the model counts
  int pairs_with_motion = 0;
  int moving_pairs = 0;  ///< in which the features had moved
};

struct CheckedRig {
  RigReport report;
  RigMeasures measures;
};

/// Reads all pairs of a recording. Throws std::runtime_error if it is unreadable. Without a pair
/// that can be used the report says why.
CheckedRig checkRig(Recording& recording, const RigCheckOptions& options);

}  // namespace rotrocc
