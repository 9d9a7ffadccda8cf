#include "sequences/calibration_file.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include <opencv2/core.hpp>

#include "evaluation/text_file.h"
#include "input/camera_calibration.h"
#include "sequences/yaml_file.h"

namespace rotrocc {
namespace {

/// The pose that a 4x4 matrix is.
Eigen::Isometry3d poseOf(const YamlFile& file, const char* key) {
  const std::vector<double> values = file.numbers(key, 16);
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(values.data());
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  if (const auto why = whyNoRotation(rotation)) {
    file.fail(
        key,
        "is not rigid: its left 3x3 part is " + *why + "; the rows of a 4x4 matrix are expected");
  }
  if (matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    file.fail(key, "is not rigid: its last row is not 0 0 0 1");
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
  pose.translation() = matrix.topRightCorner<3, 1>();
  return pose;
}

/// In the keys that ASL and Kalibr share.
RawCamera readCamera(const YamlFile& file, const char* distortion_key) {
  if (file.has("camera_model") && file.text("camera_model") != "pinhole") {
    file.fail("camera_model",
              "is " + file.text("camera_model") +
                  ", but only pinhole is supported: calibrate the camera with it, for wide lenses "
                  "with equidistant distortion");
  }
  const std::vector<double> size = file.numbers("resolution", 2);
  const std::vector<double> intrinsics = file.numbers("intrinsics", 4);
  if (!(size[0] >= 1.0 && size[1] >= 1.0 && size[0] <= 1e5 && size[1] <= 1e5)) {
    file.fail("resolution", cv::format("is %g x %g px", size[0], size[1]));
  }
  RawCamera camera;
  camera.width = static_cast<int>(size[0]);
  camera.height = static_cast<int>(size[1]);
  camera.fx = intrinsics[0];
  camera.fy = intrinsics[1];
  camera.cx = intrinsics[2];
  camera.cy = intrinsics[3];
  const std::string model = file.text("distortion_model");
  const std::vector<double> coefficients = file.numbers(distortion_key);
  try {
    camera.distortion = {model, coefficients};
    camera.check();
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(file.path() + ": " + error.what());
  }
  return camera;
}

StereoCalibration readKalibrChain(const std::string& path) {
  const YamlFile file(path);
  const YamlFile left = file.section("cam0");
  const YamlFile right = file.section("cam1");
  return chooseRectification(readCamera(left, "distortion_coeffs"),
                             readCamera(right, "distortion_coeffs"),
                             poseOf(right, "T_cn_cnm1").inverse());
}

}  // namespace

StereoCalibration readStereoCalibration(const std::vector<std::string>& paths, double baseline_m) {
  if (paths.empty() || paths.size() > 2) {
    throw std::runtime_error(
        "a calibration is two files of camera_calibration, of the left and of the right camera, or "
        "one camchain of Kalibr, not " +
        std::to_string(paths.size()) + " files");
  }
  try {
    if (paths.size() == 1) return readKalibrChain(paths[0]);
    const sensor_msgs::CameraInfo left = readCameraInfo(paths[0]);
    return toStereoCalibration(left, readCameraInfo(paths[1]), baseline_m);
  } catch (const std::invalid_argument& error) {
    const std::string names = paths.size() == 1 ? paths[0] : paths[0] + " and " + paths[1];
    throw std::runtime_error(names + ": " + error.what());
  }
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

AslCamera readAslCamera(const std::string& path) {
  const YamlFile file(path);
  return {readCamera(file, "distortion_coefficients"), poseOf(file, "T_BS")};
}

Eigen::Isometry3d readAslPose(const std::string& path) {
  if (!std::filesystem::exists(path)) return Eigen::Isometry3d::Identity();
  return poseOf(YamlFile(path), "T_BS");
}

}  // namespace rotrocc
