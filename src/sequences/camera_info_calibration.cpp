#include "sequences/camera_info_calibration.h"

#include <algorithm>
#include <vector>

#include "sequences/yaml_file.h"

namespace rotrocc {
namespace {

using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

}  // namespace

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
