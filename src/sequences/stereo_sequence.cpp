#include "sequences/stereo_sequence.h"

#include <filesystem>
#include <stdexcept>
#include <utility>

#include "inertial/gyro_file.h"
#include "rotrocc/kitti.h"
#include "sequences/calibration_file.h"
#include "sequences/kitti_mount.h"
#include "sequences/layouts.h"

namespace rotrocc {
namespace {

/// KittiSequence with KITTI's mount, and the gyroscope of imu.csv in axes of the left camera, as
/// simulate_drive --imu writes it.
std::optional<StereoSequence> readKittiLayout(const std::string& directory,
                                              const SequenceOptions& options) {
  const auto has = [&](const char* part) { return std::filesystem::exists(directory + part); };
  if (!(has("/image_0") || has("/image_1") || has("/calib.txt") || has("/times.txt"))) {
    return std::nullopt;
  }
  const KittiSequence sequence(directory, options.being_written);
  std::vector<ImagePairs::Pair> pairs;
  for (int i = 0; i < sequence.size(); ++i) {
    const std::int64_t stamp_ns = sequence.stamp_ns(i);
    pairs.push_back({{stamp_ns, sequence.leftPath(i)}, {stamp_ns, sequence.rightPath(i)}});
  }
  return StereoSequence{directory,
                        ImagePairs(std::move(pairs)),
                        rectifiedCalibration(sequence.camera()),
                        sequence.groundTruth(),
                        kittiMount()};
}

}  // namespace

StereoPair StereoSequence::read(int index) const {
  return pairs.read(index, {calibration.left.width, calibration.left.height});
}

GyroRecording StereoSequence::gyroscope(const std::string& name) const {
  using Names = std::vector<std::string>;
  for (const std::string& one : name.empty() ? Names{"imu0", "imu.csv"} : Names{name}) {
    const std::string path = root + "/" + one;
    if (std::filesystem::is_regular_file(path)) return {readGyroFile(path)};
    if (!std::filesystem::exists(path + "/data.csv")) continue;
    const Eigen::Isometry3d T_base_gyro = readAslPose(path + "/sensor.yaml");
    return {readGyroFile(path + "/data.csv"), (T_base_camera.inverse() * T_base_gyro).linear()};
  }
  if (name.empty()) return {};
  throw std::runtime_error(root + " has no gyroscope " + name +
                           ": name a folder of it, as imu0, or a CSV file");
}

std::int64_t rosTimeOffset_ns(const StereoSequence& sequence) {
  constexpr std::int64_t kDay_ns = 86'400'000'000'000;
  constexpr std::int64_t kKittiStart_ns = 1'317'600'000'000'000'000;
  return sequence.stamp_ns(0) < kDay_ns ? kKittiStart_ns : 0;
}

StereoSequence openStereoSequence(const std::string& directory, const SequenceOptions& options) {
  if (!std::filesystem::is_directory(directory)) {
    throw std::runtime_error(directory + " is not a directory");
  }
  for (const auto& readLayout : {readAslLayout, readFolderLayout, readKittiLayout}) {
    if (auto sequence = readLayout(directory, options)) return *std::move(sequence);
  }
  throw std::runtime_error(directory +
                           " is no stereo sequence: it has neither image_0 (KITTI), nor mav0/cam0 "
                           "(ASL, EuRoC), nor left and left.yaml (camera_calibration)");
}

}  // namespace rotrocc
