#include "sequences/stereo_sequence.h"

#include <filesystem>
#include <stdexcept>

#include "sequences/asl_sequence.h"
#include "sequences/calibrated_folder.h"
#include "sequences/kitti_layout.h"
#include "sequences/kitti_mount.h"

namespace rotrocc {

namespace fs = std::filesystem;

std::int64_t rosTimeOffset_ns(const StereoSequence& sequence) {
  constexpr std::int64_t kDay_ns = 86'400'000'000'000;
  return sequence.stamp_ns(0) < kDay_ns ? kKittiStart_s * 1'000'000'000 : 0;
}

std::unique_ptr<StereoSequence> openStereoSequence(const std::string& directory,
                                                   const SequenceOptions& options) {
  const fs::path root(directory);
  if (!fs::is_directory(root)) throw std::runtime_error(directory + " is not a directory");
  if (AslSequence::isLayoutOf(directory)) {
    return std::make_unique<AslSequence>(directory, options);
  }
  if (CalibratedFolder::isLayoutOf(directory)) {
    return std::make_unique<CalibratedFolder>(directory, options);
  }
  for (const char* part : {"image_0", "image_1", "calib.txt", "times.txt"}) {
    if (fs::exists(root / part)) {
      return std::make_unique<KittiLayout>(directory, options.being_written);
    }
  }
  throw std::runtime_error(directory +
                           " is no stereo sequence: it has neither image_0 (KITTI), nor mav0/cam0 "
                           "(ASL, EuRoC), nor left and left.yaml (camera_calibration)");
}

}  // namespace rotrocc
