#include "sequences/camera_info_calibration.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "input/camera_validation.h"
#include "input/input_error.h"
#include "input/to_text.h"
#include "sequences/yaml_file.h"

namespace rotrocc {
namespace {

using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

[[noreturn]] void refuse(const std::string& sentence) {
  throw InputError(DropReason::kCameraInfoInvalid, sentence);
}

RawCamera toRawCamera(const std::string& side, const sensor_msgs::CameraInfo& info) {
  const auto& K = info.K;
  const double binning_x = std::max(info.binning_x, 1u);
  const double binning_y = std::max(info.binning_y, 1u);
  if (!(K[0] > 0.0 && K[4] > 0.0)) {
    refuse("K of the " + side + " camera_info has focal lengths " + toText(K[0]) + " and " +
           toText(K[4]) + " px, but rectification needs them: calibrate the camera");
  }
  RawCamera raw;
  raw.fx = K[0] / binning_x;
  raw.fy = K[4] / binning_y;
  raw.cx = (K[2] - info.roi.x_offset) / binning_x;
  raw.cy = (K[5] - info.roi.y_offset) / binning_y;
  raw.R_rectified_raw = Eigen::Map<const Matrix3>(info.R.data());
  try {
    // Drivers without a calibration leave the name empty.
    raw.distortion = {info.distortion_model.empty() ? "plumb_bob" : info.distortion_model, info.D};
  } catch (const std::invalid_argument& error) {
    refuse("D of the " + side + " camera_info: " + error.what());
  }
  return raw;
}

void checkRaw(const std::string& side, const RawCamera& raw) {
  try {
    raw.check();
  } catch (const std::invalid_argument& error) {
    refuse("the " + side + " camera_info: " + error.what());
  }
}

}  // namespace

StereoCalibration toStereoCalibration(const sensor_msgs::CameraInfo& left,
                                      const sensor_msgs::CameraInfo& right,
                                      double baseline_m) {
  const StereoCamera rectified = toStereoCamera(left, right, baseline_m);
  StereoCalibration calibration = {
      toRawCamera("left", left), toRawCamera("right", right), rectified};
  for (RawCamera* raw : {&calibration.left, &calibration.right}) {
    raw->width = rectified.width;
    raw->height = rectified.height;
  }
  checkRaw("left", calibration.left);
  checkRaw("right", calibration.right);
  return calibration;
}

bool describesRawImages(const sensor_msgs::CameraInfo& info) {
  constexpr double kSame_px = 1e-2;
  constexpr double kSame_rad = 1e-5;
  const auto& K = info.K;
  const auto& P = info.P;
  if (K[0] == 0.0) return false;  // it says nothing about them
  const bool is_distorted =
      std::any_of(info.D.begin(), info.D.end(), [](double value) { return value != 0.0; });
  const double difference = std::max(
      {std::abs(K[0] - P[0]), std::abs(K[2] - P[2]), std::abs(K[4] - P[5]), std::abs(K[5] - P[6])});
  return is_distorted || difference > kSame_px ||
         !Eigen::Map<const Matrix3>(info.R.data()).isIdentity(kSame_rad);
}

sensor_msgs::CameraInfo toCameraInfo(const RawCamera& raw,
                                     const StereoCamera& rectified,
                                     double cx,
                                     double shift_px) {
  sensor_msgs::CameraInfo info;
  info.width = static_cast<std::uint32_t>(raw.width);
  info.height = static_cast<std::uint32_t>(raw.height);
  info.distortion_model = raw.distortion.name();
  info.D = raw.distortion.coefficients();
  info.K = {raw.fx, 0, raw.cx, 0, raw.fy, raw.cy, 0, 0, 1};
  Eigen::Map<Matrix3>(info.R.data()) = raw.R_rectified_raw;
  info.P = {rectified.fx, 0, cx, shift_px, 0, rectified.fy, rectified.cy, 0, 0, 0, 1, 0};
  return info;
}

sensor_msgs::CameraInfo readCameraInfo(const std::string& path) {
  const YamlFile file(path);
  sensor_msgs::CameraInfo info;
  info.width = static_cast<std::uint32_t>(file.pixels("image_width"));
  info.height = static_cast<std::uint32_t>(file.pixels("image_height"));
  // Old files have no name.
  if (file.has("distortion_model")) info.distortion_model = file.text("distortion_model");
  info.D = file.numbers("distortion_coefficients");
  const auto read = [&](const char* key, auto& matrix) {
    const std::vector<double> values = file.numbers(key, matrix.size());
    std::copy(values.begin(), values.end(), matrix.begin());
  };
  read("camera_matrix", info.K);
  read("rectification_matrix", info.R);
  read("projection_matrix", info.P);
  return info;
}

}  // namespace rotrocc
