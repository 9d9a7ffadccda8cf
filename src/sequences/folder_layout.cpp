#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sequences/image_folders.h"
#include "sequences/kitti_mount.h"
#include "sequences/layouts.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

Trajectory readGroundTruth(const std::string& path, const std::vector<std::int64_t>& stamps_ns) {
  if (!fs::exists(path)) return {};
  if (detectTrajectoryFormat(path) != TrajectoryFormat::kTum) {
    throw std::runtime_error(path +
                             " has no stamps: TUM format is expected, stamp [s], position "
                             "and quaternion x y z w");
  }
  return samplePoses(readTrajectory(path), stamps_ns);
}

}  // namespace

std::optional<StereoSequence> readFolderLayout(const std::string& directory,
                                               const SequenceOptions& options) {
  if (!fs::exists(directory + "/left.yaml") && !fs::is_directory(directory + "/left")) {
    return std::nullopt;
  }
  ImagePairs pairs = pairFolders(directory + "/left",
                                 directory + "/right",
                                 directory + "/times.txt",
                                 options.max_stamp_difference_s);
  const StereoCalibration calibration = calibrationOf(options, pairs, [&] {
    return readStereoCalibration({directory + "/left.yaml", directory + "/right.yaml"},
                                 {options.baseline_m});
  });
  const Trajectory truth = readGroundTruth(directory + "/groundtruth.txt", pairs.stamps_ns());
  return StereoSequence{directory, std::move(pairs), calibration, truth, mountAtCamera()};
}

}  // namespace rotrocc
