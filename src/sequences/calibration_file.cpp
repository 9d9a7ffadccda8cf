#include "sequences/calibration_file.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <boost/algorithm/string/join.hpp>
#include <opencv2/core.hpp>

#include "files/text_file.h"
#include "input/camera_calibration.h"
#include "sequences/yaml_map.h"

namespace rotrocc {
namespace {

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

template <class Matrix>
void copyNumbers(const YamlMap& file, const std::string& key, Matrix& matrix) {
  const std::vector<double> values = file.numbers(key, matrix.size());
  std::copy(values.begin(), values.end(), matrix.begin());
}

/// Of a file of camera_calibration, or of a message that rostopic has printed.
sensor_msgs::CameraInfo infoOf(const YamlMap& file) {
  const bool is_dump = !file.has("image_width") && file.has("K");
  const auto key = [&](const char* name, const char* in_message) {
    return is_dump ? in_message : name;
  };
  sensor_msgs::CameraInfo info;
  info.width = static_cast<std::uint32_t>(file.pixels(key("image_width", "width"))[0]);
  info.height = static_cast<std::uint32_t>(file.pixels(key("image_height", "height"))[0]);
  info.distortion_model = file.text("distortion_model", "plumb_bob");  // old files have none
  info.D = file.numbers(key("distortion_coefficients", "D"));
  copyNumbers(file, key("camera_matrix", "K"), info.K);
  copyNumbers(file, key("rectification_matrix", "R"), info.R);
  copyNumbers(file, key("projection_matrix", "P"), info.P);
  if (!is_dump) return info;
  const auto count = [](const YamlMap& map, const char* name) {
    return static_cast<std::uint32_t>(map.numbers(name, 1)[0]);
  };
  info.binning_x = count(file, "binning_x");
  info.binning_y = count(file, "binning_y");
  const YamlMap roi = file.section("roi");
  info.roi.x_offset = count(roi, "x_offset");
  info.roi.y_offset = count(roi, "y_offset");
  info.roi.width = count(roi, "width");
  info.roi.height = count(roi, "height");
  return info;
}

/// Of keys that begin with the name of a side.
sensor_msgs::CameraInfo sideOf(const YamlMap& file, const std::string& side) {
  sensor_msgs::CameraInfo info;
  info.width = static_cast<std::uint32_t>(file.pixels(side + "width")[0]);
  info.height = static_cast<std::uint32_t>(file.pixels(side + "height")[0]);
  info.distortion_model = "plumb_bob";
  info.D = file.numbers(side + "D");
  copyNumbers(file, side + "K", info.K);
  copyNumbers(file, side + "R", info.R);
  copyNumbers(file, side + "P", info.P);
  return info;
}

/// The files of a calibration, each of another kind, in the order of kReaders.
using Files = std::vector<YamlMap>;

/// Of a chain of Kalibr or OpenVINS: the poses of the cameras on each other, or on the IMU.
Eigen::Isometry3d poseOfRight(const YamlMap& left, const YamlMap& right) {
  if (right.has("T_cn_cnm1")) return poseOf(right, "T_cn_cnm1").inverse();
  if (right.has("T_imu_cam"))
    return poseOf(left, "T_imu_cam").inverse() * poseOf(right, "T_imu_cam");
  if (right.has("T_cam_imu"))
    return poseOf(left, "T_cam_imu") * poseOf(right, "T_cam_imu").inverse();
  right.fail("T_cn_cnm1", "is missing, and so are T_imu_cam and T_cam_imu");
}

StereoCalibration readChain(const Files& files, const StereoFileOptions&) {
  const YamlMap left = files[0].section("cam0");
  const YamlMap right = files[0].section("cam1");
  const char* const key =
      left.has("distortion_coeffs") ? "distortion_coeffs" : "distortion_coefficients";
  return chooseRectification(
      readCamera(left, key), readCamera(right, key), poseOfRight(left, right));
}

/// Of ASL (EuRoC) and Kimera.
StereoCalibration readSensors(const Files& files, const StereoFileOptions&) {
  return chooseRectification(readCamera(files[0], "distortion_coefficients"),
                             readCamera(files[1], "distortion_coefficients"),
                             poseOf(files[0], "T_BS").inverse() * poseOf(files[1], "T_BS"));
}

StereoCalibration readInfos(const Files& files, const StereoFileOptions& options) {
  const sensor_msgs::CameraInfo left = infoOf(files[0]);  // its faults are reported first
  return toStereoCalibration(left, infoOf(files[1]), options.baseline_m);
}

/// LEFT.K and the like, of ORB-SLAM2 for EuRoC.
StereoCalibration readSides(const Files& files, const StereoFileOptions& options) {
  return toStereoCalibration(
      sideOf(files[0], "LEFT."), sideOf(files[0], "RIGHT."), options.baseline_m);
}

RawCamera orbCamera(const YamlMap& file, const std::string& camera) {
  const auto number = [&](const std::string& key) { return file.numbers(camera + key, 1)[0]; };
  std::vector<double> distortion;
  const bool is_fisheye = file.text("Camera.type", "PinHole") == "KannalaBrandt8";
  for (const char* key : {"k1", "k2", is_fisheye ? "k3" : "p1", is_fisheye ? "k4" : "p2", "k3"}) {
    if (distortion.size() == 4 && is_fisheye) break;
    distortion.push_back(file.has(camera + key) ? number(key) : 0.0);
  }
  return {file.pixels("Camera.width")[0],
          file.pixels("Camera.height")[0],
          number("fx"),
          number("fy"),
          number("cx"),
          number("cy"),
          {is_fisheye ? "equidistant" : "plumb_bob", distortion}};
}

/// Of ORB-SLAM: rectified cameras with bf or b, or with a pose of the right one.
StereoCalibration readOrb(const Files& files, const StereoFileOptions& options) {
  const YamlMap& file = files[0];
  const std::string camera = file.has("Camera1.fx") ? "Camera1." : "Camera.";
  const RawCamera left = orbCamera(file, camera);
  if (file.has("Stereo.T_c1_c2")) {
    return chooseRectification(left, orbCamera(file, "Camera2."), poseOf(file, "Stereo.T_c1_c2"));
  }
  if (!left.distortion.isNone())
    file.fail(camera + "k1", "is of a lens, but there is no Stereo.T_c1_c2");
  StereoCamera rectified;
  rectified.width = left.width;
  rectified.height = left.height;
  rectified.fx = left.fx;
  rectified.fy = left.fy;
  rectified.cx = rectified.cx_right = left.cx;
  rectified.cy = left.cy;
  rectified.baseline_m = options.baseline_m > 0.0 ? options.baseline_m
                         : file.has("Stereo.b")   ? file.numbers("Stereo.b", 1)[0]
                                                  : file.numbers("Camera.bf", 1)[0] / left.fx;
  rectified.check();
  return rectifiedCalibration(rectified);
}

/// intrinsics.yml and extrinsics.yml of OpenCV's sample stereo_calib, which do not have the size of
/// the images.
StereoCalibration readOpenCv(const Files& files, const StereoFileOptions& options) {
  if (!options.sizeOfImages)
    files[0].fail(
        "M1", "is of OpenCV, whose files lack the size of the images: use them with a recording");
  const cv::Size size = options.sizeOfImages();
  const auto info = [&](const std::string& side) {
    sensor_msgs::CameraInfo info;
    info.width = static_cast<std::uint32_t>(size.width);
    info.height = static_cast<std::uint32_t>(size.height);
    info.D = files[0].numbers("D" + side);
    info.distortion_model = info.D.size() > 5 ? "rational_polynomial" : "plumb_bob";
    copyNumbers(files[0], "M" + side, info.K);
    copyNumbers(files[1], "R" + side, info.R);
    copyNumbers(files[1], "P" + side, info.P);
    return info;
  };
  return toStereoCalibration(info("1"), info("2"), options.baseline_m);
}

/// What can be read, by keys that each of the files has.
const struct {
  std::vector<const char*> keys;
  StereoCalibration (*read)(const Files&, const StereoFileOptions&);
  const char* name;
} kReaders[] = {
    {{"image_width", "image_width"}, readInfos, "two files of camera_calibration"},
    {{"distortion_model,K,P", "distortion_model,K,P"}, readInfos, "two dumps of camera_info"},
    {{"cam0"}, readChain, "a camchain of Kalibr or OpenVINS"},
    {{"T_BS,intrinsics", "T_BS,intrinsics"}, readSensors, "two files of ASL (EuRoC) or Kimera"},
    {{"LEFT.K"}, readSides, "a file of ORB-SLAM"},
    {{"Camera.fx"}, readOrb, "a file of ORB-SLAM"},
    {{"Camera1.fx"}, readOrb, "a file of ORB-SLAM"},
    {{"M1", "P1"}, readOpenCv, "intrinsics.yml and extrinsics.yml of OpenCV"}};

bool hasAll(const YamlMap& file, const std::string& keys) {
  std::istringstream list(keys);
  for (std::string key; std::getline(list, key, ',');) {
    if (!file.has(key)) return false;
  }
  return true;
}

[[noreturn]] void rejectFiles(const std::vector<std::string>& paths) {
  std::string known;
  for (const auto& reader : kReaders) {
    if (known.find(reader.name) != std::string::npos) continue;
    known += std::string(known.empty() ? "" : ", ") + reader.name;
  }
  throw std::runtime_error(
      boost::algorithm::join(paths, " and ") + (paths.size() == 1 ? " is" : " are") +
      " not a stereo calibration in a format that is read, which are: " + known +
      "; the left camera's file is first");
}

}  // namespace

StereoCalibration readStereoCalibration(const std::vector<std::string>& paths,
                                        const StereoFileOptions& options) {
  if (paths.empty() || paths.size() > 2) rejectFiles(paths);
  Files files;
  for (const std::string& path : paths) files.emplace_back(path);
  try {
    for (const auto& reader : kReaders) {
      bool fits = reader.keys.size() == files.size();
      for (std::size_t i = 0; fits && i < files.size(); ++i)
        fits = hasAll(files[i], reader.keys[i]);
      if (fits) return reader.read(files, options);
    }
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(boost::algorithm::join(paths, " and ") + ": " + error.what());
  }
  rejectFiles(paths);
}

sensor_msgs::CameraInfo readCameraInfo(const std::string& path) {
  return infoOf(YamlMap(path));
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
