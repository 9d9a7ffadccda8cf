#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include "files/image_times.h"
#include "files/text_file.h"
#include "sequences/layouts.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

std::vector<StampedImage> readImageList(const std::string& camera) {
  const std::vector<TextLine> lines = readTextLines(camera + "/data.csv");
  for (const TextLine& line : lines) line.requireColumns(2, "timestamp [ns] and file name");
  const std::vector<std::int64_t> stamps_ns = imageStamps(lines, 1);
  std::vector<StampedImage> images;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i > 0) lines[i].requireLater(stamps_ns[i], stamps_ns[i - 1]);
    images.push_back({stamps_ns[i], camera + "/data/" + lines[i].words[1]});
  }
  return images;
}

/// Poses of the left camera at the stamps of the pairs.
Trajectory readGroundTruth(const std::string& folder,
                           const Eigen::Isometry3d& T_body_camera,
                           const std::vector<std::int64_t>& stamps_ns) {
  if (!fs::exists(folder + "/data.csv")) return {};
  const Eigen::Isometry3d T_sensor_camera =
      readAslPose(folder + "/sensor.yaml").inverse() * T_body_camera;
  Trajectory poses;
  const std::vector<TextLine> lines = readTextLines(folder + "/data.csv");
  const std::int64_t unit_ns = timeUnit_ns(lines, 1);
  for (const TextLine& line : lines) {
    line.requireColumns(8, "timestamp [ns], position [m] and quaternion w x y z");
    const Eigen::Isometry3d T_world_sensor = line.quaternionPose(true);
    const std::int64_t stamp_ns = line.nanoseconds(0, unit_ns);
    if (!poses.empty()) line.requireLater(stamp_ns, poses.back().stamp_ns);
    poses.push_back({stamp_ns, T_world_sensor * T_sensor_camera});
  }
  return samplePoses(poses, stamps_ns);
}

}  // namespace

std::optional<StereoSequence> readAslLayout(const std::string& directory,
                                            const SequenceOptions& options) {
  const std::string nested = (fs::path(directory) / "mav0").string();
  const std::string root = fs::is_directory(nested) ? nested : directory;
  if (!fs::is_directory(root + "/cam0")) return std::nullopt;
  ImagePairs pairs(
      readImageList(root + "/cam0"), readImageList(root + "/cam1"), options.max_stamp_difference_s);
  const AslCamera left = readAslCamera(root + "/cam0/sensor.yaml");
  const AslCamera right = readAslCamera(root + "/cam1/sensor.yaml");
  StereoCalibration calibration;
  try {
    calibration = calibrationOf(options, pairs, [&] {
      return chooseRectification(
          left.camera, right.camera, left.T_body_camera.inverse() * right.T_body_camera);
    });
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(root + "/cam0/sensor.yaml and cam1/sensor.yaml: " + error.what());
  }
  // Of the rectified camera.
  const Eigen::Isometry3d T_body_camera =
      left.T_body_camera * Eigen::Quaterniond(calibration.left.R_rectified_raw).inverse();
  const Trajectory truth =
      readGroundTruth(root + "/state_groundtruth_estimate0", T_body_camera, pairs.stamps_ns());
  return StereoSequence{root, std::move(pairs), calibration, truth, T_body_camera};
}

}  // namespace rotrocc
