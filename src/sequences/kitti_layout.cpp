#include "rotrocc/kitti.h"

#include <filesystem>
#include <utility>
#include <vector>

#include "sequences/kitti_mount.h"
#include "sequences/layouts.h"

namespace rotrocc {

std::optional<StereoSequence> readKittiLayout(const std::string& directory,
                                              const SequenceOptions& options) {
  namespace fs = std::filesystem;
  const auto has = [&](const char* part) { return fs::exists(fs::path(directory) / part); };
  if (!(has("image_0") || has("image_1") || has("calib.txt") || has("times.txt"))) {
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

}  // namespace rotrocc
