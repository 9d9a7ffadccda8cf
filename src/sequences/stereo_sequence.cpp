#include "sequences/stereo_sequence.h"

#include <filesystem>
#include <stdexcept>
#include <utility>

#include "files/image_file.h"
#include "sequences/calibration_file.h"
#include "sequences/gyro_file.h"
#include "sequences/layouts.h"

namespace rotrocc {
cv::Size sizeOf(const ImagePairs& pairs) {
  return readGrayImage(pairs.pair(0).left.path).size();
}

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
  for (const auto& readLayout :
       {readAslLayout, readFolderLayout, readKittiRawLayout, readKittiLayout}) {
    if (auto sequence = readLayout(directory, options)) return *std::move(sequence);
  }
  throw std::runtime_error(directory +
                           " is no stereo sequence: it has neither image_0 or image_2 (KITTI), nor "
                           "image_00 or image_02 (KITTI raw), nor mav0/cam0 (ASL, EuRoC), nor left "
                           "and left.yaml (camera_calibration)");
}

}  // namespace rotrocc
