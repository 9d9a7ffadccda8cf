#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

#include "evaluation/text_file.h"
#include "evaluation/trajectory_sampling.h"
#include "inertial/gyro_file.h"
#include "sequences/layouts.h"
#include "sequences/yaml_file.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

std::string rootOf(const std::string& directory) {
  const fs::path nested = fs::path(directory) / "mav0";
  return fs::is_directory(nested) ? nested.string() : directory;
}

void requireColumns(const TextLine& line, std::size_t columns, const std::string& what) {
  if (line.words.size() >= columns) return;
  throw std::runtime_error(line.where + " has " + std::to_string(line.words.size()) +
                           " columns: " + what + " are expected, separated by commas");
}

std::vector<StampedImage> readImageList(const std::string& camera) {
  std::vector<StampedImage> images;
  for (const TextLine& line : readTextLines(camera + "/data.csv", ',')) {
    requireColumns(line, 2, "timestamp [ns] and file name");
    const std::int64_t stamp_ns = line.integer(0);
    if (!images.empty()) line.requireLater(stamp_ns, images.back().stamp_ns);
    images.push_back({stamp_ns, camera + "/data/" + line.words[1]});
  }
  return images;
}

StereoCalibration readCalibration(const AslCamera& left,
                                  const AslCamera& right,
                                  const std::string& root) {
  try {
    return chooseRectification(
        left.camera, right.camera, left.T_body_camera.inverse() * right.T_body_camera);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(root + "/cam0/sensor.yaml and cam1/sensor.yaml: " + error.what());
  }
}

/// Poses of the left camera at the stamps of the pairs.
Trajectory readGroundTruth(const std::string& folder,
                           const Eigen::Isometry3d& T_body_camera,
                           const std::vector<std::int64_t>& stamps_ns) {
  if (!fs::exists(folder + "/data.csv")) return {};
  const Eigen::Isometry3d T_sensor_camera =
      readAslPose(folder + "/sensor.yaml").inverse() * T_body_camera;
  Trajectory poses;
  for (const TextLine& line : readTextLines(folder + "/data.csv", ',')) {
    requireColumns(line, 8, "timestamp [ns], position [m] and quaternion w x y z");
    const Eigen::Isometry3d T_world_sensor = line.quaternionPose(true);
    const std::int64_t stamp_ns = line.integer(0);
    if (!poses.empty()) line.requireLater(stamp_ns, poses.back().stamp_ns);
    poses.push_back({stamp_ns, T_world_sensor * T_sensor_camera});
  }
  return samplePoses(poses, stamps_ns);
}

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
  if (!fs::exists(path)) return Eigen::Isometry3d::Identity();
  return poseOf(YamlFile(path));
}

std::optional<StereoSequence> readAslLayout(const std::string& directory,
                                            const SequenceOptions& options) {
  const std::string root = rootOf(directory);
  if (!fs::is_directory(root + "/cam0")) return std::nullopt;
  ImagePairs pairs(
      readImageList(root + "/cam0"), readImageList(root + "/cam1"), options.max_stamp_difference_s);
  const AslCamera left = readAslCamera(root + "/cam0/sensor.yaml");
  const AslCamera right = readAslCamera(root + "/cam1/sensor.yaml");
  const StereoCalibration calibration = readCalibration(left, right, root);
  // Of the rectified camera.
  const Eigen::Isometry3d T_body_camera =
      left.T_body_camera * Eigen::Quaterniond(calibration.left.R_rectified_raw).inverse();
  const Trajectory truth =
      readGroundTruth(root + "/state_groundtruth_estimate0", T_body_camera, pairs.stamps_ns());
  const auto gyroscope = [root, T_body_camera](const std::string& name) -> GyroRecording {
    const std::string folder = root + "/" + name;
    if (!fs::exists(folder + "/data.csv")) {
      throw std::runtime_error(folder +
                               "/data.csv does not exist: name a folder of the sequence, as imu0, "
                               "or a CSV file");
    }
    const Eigen::Isometry3d T_body_gyro = readAslPose(folder + "/sensor.yaml");
    return {readGyroFile(folder + "/data.csv"), (T_body_camera.inverse() * T_body_gyro).linear()};
  };
  return StereoSequence{std::move(pairs),
                        calibration,
                        truth,
                        T_body_camera,
                        gyroscope,
                        fs::exists(root + "/imu0/data.csv") ? "imu0" : ""};
}

}  // namespace rotrocc
