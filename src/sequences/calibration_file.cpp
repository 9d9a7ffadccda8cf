#include "sequences/calibration_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <yaml-cpp/yaml.h>
#include <opencv2/core.hpp>

#include "common/read_yaml.h"
#include "evaluation/text_file.h"
#include "input/camera_calibration.h"

namespace rotrocc {
namespace {

/// A map in a YAML file. Its functions throw std::runtime_error "PATH: KEY WHAT" if a value is
/// missing or of another kind.
///
/// camera_calibration_parsers reads such files, too, but does not say what is wrong, and ends the
/// program if a matrix has another size.
class YamlMap {
 public:
  explicit YamlMap(const std::string& path) : path_(path) {
    try {
      map_ = readYaml(path);
    } catch (const YAML::Exception& error) {
      throw std::runtime_error(path + " is not YAML: " + error.what());
    }
    if (!map_.IsMap()) throw std::runtime_error(path + " has no keys: is it the right file?");
  }

  YamlMap section(const std::string& key) const {
    const YAML::Node node = find(key);
    if (!node.IsMap()) fail(key, "is not a map");
    return {path_ + ": " + key, node};
  }

  /// Of the file, and the keys of sections.
  const std::string& path() const { return path_; }

  std::string text(const std::string& key) const {
    const YAML::Node node = find(key);
    if (!node.IsScalar()) fail(key, "is not a value");
    return node.Scalar();
  }

  /// `otherwise` if there is no such key.
  std::string text(const std::string& key, const std::string& otherwise) const {
    return map_[key].IsDefined() ? text(key) : otherwise;
  }

  /// Finite numbers, `count` of them unless that is 0: one, a list, a list of rows, or the list
  /// `data` of a matrix.
  std::vector<double> numbers(const std::string& key, std::size_t count = 0) const {
    const YAML::Node node = find(key);
    std::vector<double> numbers;
    append(key, node.IsMap() ? node["data"] : node, numbers);
    if (count == 0 || numbers.size() == count) return numbers;
    fail(key, cv::format("has %zu numbers instead of %zu", numbers.size(), count));
  }

  /// Image sizes: integers from 1 to 1e5.
  std::vector<int> pixels(const std::string& key, std::size_t count = 1) const {
    std::vector<int> pixels;
    for (const double value : numbers(key, count)) {
      if (!(value >= 1.0 && value <= 1e5 && value == std::floor(value))) {
        fail(key, cv::format("is %g, not a number of pixels", value));
      }
      pixels.push_back(static_cast<int>(value));
    }
    return pixels;
  }

  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw std::runtime_error(path_ + ": " + key + " " + what);
  }

 private:
  YamlMap(const std::string& path, const YAML::Node& map) : path_(path), map_(map) {}

  YAML::Node find(const std::string& key) const {
    const YAML::Node node = map_[key];
    if (!node.IsDefined()) fail(key, "is missing");
    return node;
  }

  void append(const std::string& key, const YAML::Node& node, std::vector<double>& numbers) const {
    if (node.IsDefined() && node.IsSequence()) {
      for (const YAML::Node& entry : node) append(key, entry, numbers);
      return;
    }
    double number = 0.0;
    const bool is_number = node.IsDefined() && YAML::convert<double>::decode(node, number);
    if (!is_number || !std::isfinite(number)) {
      fail(key, cv::format("has a value that is not a finite number, after %zu", numbers.size()));
    }
    numbers.push_back(number);
  }

  std::string path_;
  YAML::Node map_;
};

/// The pose that a 4x4 matrix is.
Eigen::Isometry3d poseOf(const YamlMap& file, const char* key) {
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
RawCamera readCamera(const YamlMap& file, const char* distortion_key) {
  const std::string projection = file.text("camera_model", "pinhole");
  if (projection != "pinhole") {
    file.fail("camera_model",
              "is " + projection +
                  ", but only pinhole is supported: calibrate the camera with it, for wide lenses "
                  "with equidistant distortion");
  }
  const std::vector<int> size = file.pixels("resolution", 2);
  const std::vector<double> intrinsics = file.numbers("intrinsics", 4);
  const std::string model = file.text("distortion_model");
  const std::vector<double> coefficients = file.numbers(distortion_key);
  try {
    RawCamera camera = {size[0],
                        size[1],
                        intrinsics[0],
                        intrinsics[1],
                        intrinsics[2],
                        intrinsics[3],
                        {model, coefficients}};
    camera.check();
    return camera;
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(file.path() + ": " + error.what());
  }
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
    if (paths.size() == 2) {
      const sensor_msgs::CameraInfo left = readCameraInfo(paths[0]);
      return toStereoCalibration(left, readCameraInfo(paths[1]), baseline_m);
    }
    const YamlMap chain(paths[0]);
    const YamlMap left = chain.section("cam0");
    const YamlMap right = chain.section("cam1");
    return chooseRectification(readCamera(left, "distortion_coeffs"),
                               readCamera(right, "distortion_coeffs"),
                               poseOf(right, "T_cn_cnm1").inverse());
  } catch (const std::invalid_argument& error) {
    const std::string names = paths.size() == 1 ? paths[0] : paths[0] + " and " + paths[1];
    throw std::runtime_error(names + ": " + error.what());
  }
}

sensor_msgs::CameraInfo readCameraInfo(const std::string& path) {
  const YamlMap file(path);
  sensor_msgs::CameraInfo info;
  info.width = static_cast<std::uint32_t>(file.pixels("image_width")[0]);
  info.height = static_cast<std::uint32_t>(file.pixels("image_height")[0]);
  info.distortion_model = file.text("distortion_model", "plumb_bob");  // old files have none
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
  const YamlMap file(path);
  return {readCamera(file, "distortion_coefficients"), poseOf(file, "T_BS")};
}

Eigen::Isometry3d readAslPose(const std::string& path) {
  if (!std::filesystem::exists(path)) return Eigen::Isometry3d::Identity();
  return poseOf(YamlMap(path), "T_BS");
}

}  // namespace rotrocc
