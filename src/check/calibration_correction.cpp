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

/// Whether something needs fixing that a calibration corrects. Smaller errors are not worth it:
/// lenses have others of that size.
bool hasErrors(const RigModel& model) {
  const RigCause causes[] = {kRoll, kPitch, kYaw, kFocal, kOffset, kLens, kBias};
  return std::any_of(std::begin(causes), std::end(causes), [&](RigCause cause) {
    return model.correctable[cause] != 0.0 && model.exceeds(1.0, cause);
  });
}

/// Whether windows that a calibration is not from say that it is better, beyond their scatter.
/// Flows, of which motions are made, must not get worse.
bool isBetter(const RigModel& model) {
  const Estimate &rows = model.rows_gain, &flow = model.flow_gain;
  const Estimate sum = {rows.value + flow.value, std::hypot(rows.sigma, flow.sigma)};
  return sum.value > 0.0 && sum.certain() > 0.0 && flow.value >= -flow.sigma;
}

/// Why there is no correction; empty if there may be one.
std::string whyNone(const RigMeasures& measures) {
  if (measures.moving_pairs < kLeastMotions) {
    return "features moved in fewer than " + toText(kLeastMotions) +
           " pairs: record a minute of motion";
  }
  if (!measures.is_known)
    return "the images are not stereo pairs, or not rectified: fix that first";
  if (!measures.rest.is_constant)
    return "rows or disparities change over time: no calibration fits a rig that bends";
  if (hasErrors(measures.model)) {
    if (isBetter(measures.model)) return "";
    return "it does not improve the fit on held-out parts of the recording";
  }
  if (!measures.model.exceeds(1.0, kBias))
    return "rows and disparities have no error that needs fixing";
  return "the images do not show which of two causes it is, and correcting the wrong one would not "
         "help: drive where features fill the image";
}

/// The calibration that makes rows equal and disparities right. The right camera takes all of it:
/// what both cameras have in common, as an error of the baseline, is not seen.
StereoCalibration correct(const RigMeasures& measures) {
  StereoCalibration corrected = measures.calibration;
  RawCamera& right = corrected.right;
  const RigCauses causes = measures.model.correctable;
  right.cx += causes[kBias] * right.fx / corrected.rectified.fx;
  right.cy += causes[kOffset] * right.fy / corrected.rectified.fy;
  right.R_rectified_raw = rotationOf(causes) * right.R_rectified_raw;
  right.fx *= 1.0 + causes[kFocal];
  right.fy *= 1.0 + causes[kFocal];
  std::vector<double> coefficients = right.distortion.coefficients();
  if (!coefficients.empty()) {
    coefficients.front() += causes[kLens];
    right.distortion = {right.distortion.name(), coefficients};
  }
  return corrected;
}

}  // namespace

std::optional<CheckedRig> findCorrection(Recording& recording,
                                         const RigCheckOptions& options,
                                         const RigMeasures& before,
                                         std::string& why_not) {
  why_not = whyNone(before);
  if (!why_not.empty()) return std::nullopt;
  // Again by what is left over, because the fit is linear and pairs that were lost come back.
  constexpr int kMostPasses = 4;
  RigCheckOptions corrected = options;
  corrected.on_pair = [] {};
  CheckedRig checked = {{}, before};
  for (int pass = 0; pass < kMostPasses && hasErrors(checked.measures.model); ++pass) {
    corrected.calibration = std::make_shared<const StereoCalibration>(correct(checked.measures));
    checked = checkRig(recording, corrected);
  }
  if (checked.measures.pairs_with_motion < before.pairs_with_motion) {
    why_not = "more pairs would be lost";
    return std::nullopt;
  }
  return checked;
}

void writeCalibration(const StereoCalibration& calibration, const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  const auto [left, right] = toCameraInfos(calibration);
  for (const auto& [name, info] : {std::pair("left", left), {"right", right}}) {
    const std::string path = directory + "/" + name + ".yaml";
    std::ofstream out(path);
    camera_calibration_parsers::writeCalibrationYml(out, name, info);
    if (!out.flush()) throw std::runtime_error(path + " cannot be written");
  }
}

}  // namespace rotrocc
