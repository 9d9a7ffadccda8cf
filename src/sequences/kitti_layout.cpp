#include "rotrocc/kitti.h"

#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include "inertial/gyro_file.h"
#include "sequences/kitti_mount.h"
#include "sequences/layouts.h"

namespace rotrocc {

StereoSequence::Parts readKittiLayout(const std::string& directory,
                                      const SequenceOptions& options) {
  const KittiSequence sequence(directory, options.being_written);
  std::vector<ImagePairs::Pair> pairs;
  for (int i = 0; i < sequence.size(); ++i) {
    const std::int64_t stamp_ns = sequence.stamp_ns(i);
    pairs.push_back({{stamp_ns, sequence.leftPath(i)}, {stamp_ns, sequence.rightPath(i)}});
  }
  const auto gyroscope = [directory](const std::string& name) -> GyroRecording {
    const std::string file = directory + "/" + name;
    if (std::filesystem::is_regular_file(file)) return {readGyroFile(file)};
    throw std::runtime_error("there is no file " + name + " with a gyroscope");
  };
  return {ImagePairs(std::move(pairs)),
          rectifiedCalibration(sequence.camera()),
          sequence.groundTruth(),
          kittiMount(),
          gyroscope,
          std::filesystem::is_regular_file(directory + "/imu.csv") ? "imu.csv" : ""};
}

}  // namespace rotrocc
