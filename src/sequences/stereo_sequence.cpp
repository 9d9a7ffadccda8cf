#include "sequences/stereo_sequence.h"

#include <filesystem>
#include <stdexcept>

#include "sequences/kitti_mount.h"
#include "sequences/layouts.h"

namespace rotrocc {

StereoPair StereoSequence::read(int index) {
  return pairs.read(index, {calibration.left.width, calibration.left.height});
}

GyroRecording StereoSequence::gyroscope(const std::string& name) const {
  if (!name.empty()) return named_gyroscope(name);
  return usual_gyroscope.empty() ? GyroRecording() : named_gyroscope(usual_gyroscope);
}

std::int64_t rosTimeOffset_ns(const StereoSequence& sequence) {
  constexpr std::int64_t kDay_ns = 86'400'000'000'000;
  return sequence.stamp_ns(0) < kDay_ns ? kKittiStart_s * 1'000'000'000 : 0;
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
