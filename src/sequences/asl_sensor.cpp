#include "sequences/asl_sensor.h"

#include <filesystem>
#include <stdexcept>

#include <opencv2/core.hpp>

#include "evaluation/pose_text.h"
#include "sequences/yaml_file.h"

namespace rotrocc {
namespace {

Eigen::Isometry3d poseOf(const YamlFile& file) {
  const std::vector<double> values = file.numbers("T_BS", 16);
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(values.data());
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  if (const std::string why = whyNoRotation(rotation); !why.empty()) {
    file.fail(
        "T_BS",
        "is not rigid: its left 3x3 part is " + why + "; the rows of a 4x4 matrix are expected");
  }
  if (matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    file.fail("T_BS", "is not rigid: its last row is not 0 0 0 1");
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
  pose.translation() = matrix.topRightCorner<3, 1>();
  return pose;
}

}  // namespace

AslCamera readAslCamera(const std::string& path) {
  const YamlFile file(path);
  if (file.has("camera_model") && file.text("camera_model") != "pinhole") {
    file.fail("camera_model",
              "is " + file.text("camera_model") +
                  ", but only pinhole is supported: calibrate the camera with it, for wide lenses "
                  "with equidistant distortion");
  }
  const std::vector<double> size = file.numbers("resolution", 2);
  const std::vector<double> intrinsics = file.numbers("intrinsics", 4);
  AslCamera sensor;
  RawCamera& camera = sensor.camera;
  if (!(size[0] >= 1.0 && size[1] >= 1.0 && size[0] <= 1e5 && size[1] <= 1e5)) {
    file.fail("resolution", cv::format("is %g x %g px", size[0], size[1]));
  }
  camera.width = static_cast<int>(size[0]);
  camera.height = static_cast<int>(size[1]);
  camera.fx = intrinsics[0];
  camera.fy = intrinsics[1];
  camera.cx = intrinsics[2];
  camera.cy = intrinsics[3];
  sensor.T_body_camera = poseOf(file);
  try {
    camera.distortion = {file.text("distortion_model"), file.numbers("distortion_coefficients")};
    camera.check();
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  return sensor;
}

Eigen::Isometry3d readAslPose(const std::string& path) {
  if (!std::filesystem::exists(path)) return Eigen::Isometry3d::Identity();
  return poseOf(YamlFile(path));
}

}  // namespace rotrocc
