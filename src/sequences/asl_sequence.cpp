#include "sequences/asl_sequence.h"

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "evaluation/text_file.h"
#include "evaluation/trajectory_sampling.h"
#include "inertial/gyro_file.h"
#include "sequences/asl_sensor.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

/// Poses are not interpolated over more than this: EuRoC's have 200 Hz.
constexpr std::int64_t kMaxGap_ns = 100'000'000;

std::string rootOf(const std::string& directory) {
  const fs::path nested = fs::path(directory) / "mav0";
  return fs::is_directory(nested) ? nested.string() : directory;
}

void requireColumns(const TextLine& line, std::size_t columns, const std::string& what) {
  if (line.words.size() >= columns) return;
  throw std::runtime_error(line.where + " has " + std::to_string(line.words.size()) +
                           " columns: " + what + " are expected, separated by commas");
}

void requireLater(const TextLine& line, std::int64_t stamp_ns, std::int64_t previous_ns) {
  if (stamp_ns > previous_ns) return;
  throw std::runtime_error(line.where + ": the timestamp " + line.words.front() +
                           " ns is not later than the one before it: sort the file by time");
}

std::vector<StampedImage> readImageList(const std::string& camera) {
  std::vector<StampedImage> images;
  for (const TextLine& line : readTextLines(camera + "/data.csv", ',')) {
    requireColumns(line, 2, "timestamp [ns] and file name");
    const std::int64_t stamp_ns = line.integer(0);
    if (!images.empty()) requireLater(line, stamp_ns, images.back().stamp_ns);
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

Eigen::Isometry3d poseOf(const TextLine& line) {
  requireColumns(line, 8, "timestamp [ns], position [m] and quaternion w x y z");
  const Eigen::Quaterniond q(line.number(4), line.number(5), line.number(6), line.number(7));
  if (!(std::abs(q.norm() - 1.0) < 1e-2)) {
    throw std::runtime_error(line.where + ": the quaternion has the length " +
                             std::to_string(q.norm()) + " instead of 1");
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(line.number(1), line.number(2), line.number(3));
  return pose;
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
    const Eigen::Isometry3d T_world_sensor = poseOf(line);
    const std::int64_t stamp_ns = line.integer(0);
    if (!poses.empty()) requireLater(line, stamp_ns, poses.back().stamp_ns);
    poses.push_back({stamp_ns, T_world_sensor * T_sensor_camera});
  }
  return samplePoses(poses, stamps_ns, kMaxGap_ns);
}

}  // namespace

bool AslSequence::isLayoutOf(const std::string& directory) {
  return fs::is_directory(rootOf(directory) + "/cam0");
}

AslSequence::AslSequence(const std::string& directory, const SequenceOptions& options)
    : directory_(directory),
      root_(rootOf(directory)),
      pairs_(readImageList(root_ + "/cam0"),
             readImageList(root_ + "/cam1"),
             options.max_stamp_difference_s) {
  const AslCamera left = readAslCamera(root_ + "/cam0/sensor.yaml");
  const AslCamera right = readAslCamera(root_ + "/cam1/sensor.yaml");
  calibration_ = readCalibration(left, right, root_);
  T_body_camera_ =
      left.T_body_camera * Eigen::Quaterniond(calibration_.left.R_rectified_raw).inverse();
  ground_truth_ =
      readGroundTruth(root_ + "/state_groundtruth_estimate0", T_body_camera_, pairs_.stamps_ns());
}

StereoPair AslSequence::read(int index) {
  return pairs_.read(index, {calibration_.left.width, calibration_.left.height});
}

GyroRecording AslSequence::gyroscope(const std::string& name) const {
  const std::string folder = root_ + "/" + (name.empty() ? "imu0" : name);
  const std::string file = folder + "/data.csv";
  if (!fs::exists(file)) {
    if (name.empty()) return {};
    throw std::runtime_error(file +
                             " does not exist: name a folder of the sequence, as imu0, or a "
                             "CSV file");
  }
  const Eigen::Isometry3d T_body_gyro = readAslPose(folder + "/sensor.yaml");
  return {readGyroFile(file), (T_body_camera_.inverse() * T_body_gyro).linear()};
}

}  // namespace rotrocc
