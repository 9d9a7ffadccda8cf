#include "sequences/stereo_sequence.h"

#include <filesystem>
#include <stdexcept>
#include <utility>

#include "sequences/kitti_mount.h"
#include "sequences/layouts.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

StereoSequence::Parts readLayout(const std::string& directory, const SequenceOptions& options) {
  if (!fs::is_directory(directory)) throw std::runtime_error(directory + " is not a directory");
  if (isAslLayout(directory)) return readAslLayout(directory, options);
  if (isFolderLayout(directory)) return readFolderLayout(directory, options);
  for (const char* part : {"image_0", "image_1", "calib.txt", "times.txt"}) {
    if (fs::exists(fs::path(directory) / part)) return readKittiLayout(directory, options);
  }
  throw std::runtime_error(directory +
                           " is no stereo sequence: it has neither image_0 (KITTI), nor mav0/cam0 "
                           "(ASL, EuRoC), nor left and left.yaml (camera_calibration)");
}

}  // namespace

StereoSequence::StereoSequence(const std::string& directory, Parts parts)
    : directory_(directory), parts_(std::move(parts)) {}

StereoPair StereoSequence::read(int index) {
  const RawCamera& camera = parts_.calibration.left;
  return parts_.pairs.read(index, {camera.width, camera.height});
}

GyroRecording StereoSequence::gyroscope(const std::string& name) const {
  if (!name.empty()) return parts_.gyroscope(name);
  if (parts_.usual_gyroscope.empty()) return {};
  return parts_.gyroscope(parts_.usual_gyroscope);
}

std::int64_t rosTimeOffset_ns(const StereoSequence& sequence) {
  constexpr std::int64_t kDay_ns = 86'400'000'000'000;
  return sequence.stamp_ns(0) < kDay_ns ? kKittiStart_s * 1'000'000'000 : 0;
}

std::unique_ptr<StereoSequence> openStereoSequence(const std::string& directory,
                                                   const SequenceOptions& options) {
  return std::make_unique<StereoSequence>(directory, readLayout(directory, options));
}

}  // namespace rotrocc
