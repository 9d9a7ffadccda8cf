#include "check/calibration_correction.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include <camera_calibration_parsers/parse_yml.h>
#include <sensor_msgs/CameraInfo.h>

#include "input/camera_calibration.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

void writeInfo(const sensor_msgs::CameraInfo& info,
               const std::string& name,
               const std::string& path) {
  std::ofstream out(path);
  camera_calibration_parsers::writeCalibrationYml(out, name, info);
  if (!out.flush()) throw std::runtime_error(path + " cannot be written");
}

/// Whether disparities have a bias rather than none: the odometry applies the share that is likely.
bool isBiased(const DisparityBias& bias) {
  return bias.applied_px / bias.estimated_px > 0.5;
}

/// Whether a calibration can make something better: rows that are not significant are zero.
bool hasErrors(const RigMeasures& measures) {
  const RowCauses& causes = measures.rows.causes;
  const auto isCause = [](double value) { return value != 0.0; };
  return std::any_of(causes.begin(), causes.begin() + kTimeSkew, isCause) ||
         isBiased(measures.bias);
}

std::optional<std::string> whyWorse(const RigMeasures& before, const RigMeasures& after) {
  constexpr double kWorse = 1.05;
  // Over the way: smaller differences are those of a perfect rig.
  constexpr double kLeastDifference = 0.004;
  if (after.pairs_with_motion < before.pairs_with_motion) return "more pairs would be lost";
  if (after.rows_rms_px > kWorse * before.rows_rms_px) {
    return "rows would differ by " + fixedText(after.rows_rms_px, 2) + " px in place of " +
           fixedText(before.rows_rms_px, 2) + " px";
  }
  const auto& [before_share, before_sigma] = before.replay_share;
  const double after_share = after.replay_share.value;
  if (before_share > 0.0 && after_share > std::max(before_share + before_sigma, kLeastDifference)) {
    return "repeated motions would differ by " + fixedText(100.0 * after_share, 2) +
           " m in 100 m in place of " + fixedText(100.0 * before_share, 2) + " m";
  }
  return std::nullopt;
}

}  // namespace

StereoCalibration correct(const RigMeasures& measures) {
  StereoCalibration corrected = measures.calibration;
  RawCamera& right = corrected.right;
  const RowCauses& causes = measures.rows.causes;
  const double raw_over_rectified = right.fx / corrected.rectified.fx;
  right.R_rectified_raw = rotationOf(causes) * right.R_rectified_raw;
  right.fx *= 1.0 + causes[kFocal];
  right.fy *= 1.0 + causes[kFocal];
  right.cy += causes[kOffset] * raw_over_rectified;
  std::vector<double> coefficients = right.distortion.coefficients();
  if (!coefficients.empty()) {
    coefficients.front() += causes[kLens];
    right.distortion = {right.distortion.name(), coefficients};
  }
  if (isBiased(measures.bias)) right.cx += measures.bias.estimated_px * raw_over_rectified;
  return corrected;
}

std::optional<CheckedRig> findCorrection(Recording& recording,
                                         const RigCheckOptions& options,
                                         const RigMeasures& before,
                                         std::string& why_not) {
  if (before.pairs_with_motion < kLeastMotions) {
    why_not = "fewer than " + toText(kLeastMotions) + " pairs have a motion: record a minute";
    return std::nullopt;
  }
  if (!before.rows_are_constant) {
    why_not = "rows move against each other: no calibration describes a rig that bends";
    return std::nullopt;
  }
  if (!hasErrors(before)) {
    why_not = "rows and disparities have no error beyond their uncertainty";
    return std::nullopt;
  }
  // Again by what is left over: rows first, then the disparities that they leave.
  constexpr int kMostPasses = 4;
  RigCheckOptions corrected = options;
  CheckedRig checked = {{}, before};
  for (int pass = 0; pass < kMostPasses && hasErrors(checked.measures); ++pass) {
    corrected.calibration = std::make_shared<const StereoCalibration>(correct(checked.measures));
    checked = checkRig(recording, corrected);
  }
  const auto why_worse = whyWorse(before, checked.measures);
  if (!why_worse) return checked;
  why_not = *why_worse;
  return std::nullopt;
}

void writeCalibration(const StereoCalibration& calibration, const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  const auto [left, right] = toCameraInfos(calibration);
  writeInfo(left, "left", directory + "/left.yaml");
  writeInfo(right, "right", directory + "/right.yaml");
}

}  // namespace rotrocc
