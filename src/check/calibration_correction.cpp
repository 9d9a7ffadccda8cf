#include "check/calibration_correction.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <stdexcept>
#include <utility>
#include <vector>

#include <sensor_msgs/CameraInfo.h>
#include <yaml-cpp/yaml.h>

#include "check/recalibrated_recording.h"
#include "input/camera_calibration.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

template <class Numbers>
YAML::Node matrixOf(int rows, const Numbers& numbers) {
  YAML::Node matrix;
  matrix["rows"] = rows;
  matrix["cols"] = static_cast<int>(numbers.size()) / rows;
  YAML::Node data(YAML::NodeType::Sequence);
  for (const double number : numbers) data.push_back(exactText(number));
  data.SetStyle(YAML::EmitterStyle::Flow);
  matrix["data"] = data;
  return matrix;
}

void writeInfo(const sensor_msgs::CameraInfo& info,
               const std::string& name,
               const std::string& path) {
  YAML::Node file;
  file["image_width"] = info.width;
  file["image_height"] = info.height;
  file["camera_name"] = name;
  file["camera_matrix"] = matrixOf(3, info.K);
  file["distortion_model"] = info.distortion_model;
  file["distortion_coefficients"] = matrixOf(1, info.D);
  file["rectification_matrix"] = matrixOf(3, info.R);
  file["projection_matrix"] = matrixOf(3, info.P);
  std::ofstream out(path);
  out << file << '\n';
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

/// Again by what is left over: rows first, then the disparities that they leave.
Correction correctedBy(Recording& recording, const RigCheckOptions& options, RigMeasures measures) {
  RigCheckOptions rectified = options;
  rectified.rectify = "yes";
  constexpr int kMostPasses = 4;
  Correction correction;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    if (pass > 0 && !hasErrors(measures)) break;
    correction.calibration = correct(measures);
    RecalibratedRecording recalibrated(recording, correction.calibration);
    correction.checked = checkRig(recalibrated, rectified);
    measures = correction.checked.measures;
    measures.calibration = correction.calibration;
  }
  return correction;
}

/// Empty if it is not.
std::string whyWorse(const RigMeasures& before, const RigMeasures& after) {
  constexpr double kWorse = 1.05;
  // Over the way: smaller differences are those of a perfect rig.
  constexpr double kLeastDifference = 0.004;
  if (after.pairs_with_motion < before.pairs_with_motion) return "more pairs would be lost";
  if (after.rows_rms_px > kWorse * before.rows_rms_px) {
    return "rows would differ by " + fixedText(after.rows_rms_px, 2) + " px in place of " +
           fixedText(before.rows_rms_px, 2) + " px";
  }
  const bool is_comparable = before.replay_share > 0.0;
  if (is_comparable &&
      after.replay_share > std::max(kWorse * before.replay_share, kLeastDifference)) {
    return "repeated motions would differ by " + fixedText(100.0 * after.replay_share, 2) +
           " m in 100 m in place of " + fixedText(100.0 * before.replay_share, 2) + " m";
  }
  return "";
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

std::optional<Correction> findCorrection(Recording& recording,
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
  Correction correction = correctedBy(recording, options, before);
  why_not = whyWorse(before, correction.checked.measures);
  if (!why_not.empty()) return std::nullopt;
  return correction;
}

void writeCalibration(const StereoCalibration& calibration, const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  const auto [left, right] = toCameraInfos(calibration);
  writeInfo(left, "left", directory + "/left.yaml");
  writeInfo(right, "right", directory + "/right.yaml");
}

}  // namespace rotrocc
