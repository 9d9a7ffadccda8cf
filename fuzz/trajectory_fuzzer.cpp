// Pose files in KITTI or TUM format, and time files.

#include <stdexcept>

#include "input_file.h"
#include "require.h"
#include "rotrocc/trajectory.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

const TemporaryDirectory& directory() {
  static const TemporaryDirectory directory;
  return directory;
}

/// A trajectory that was read can be written, and read again.
void requireRoundTrip(const Trajectory& trajectory) {
  static const std::string path = directory() / "written.txt";
  {
    TrajectoryWriter writer(path, TrajectoryFormat::kTum);
    for (const StampedPose& pose : trajectory) writer.write(pose);
  }
  const Trajectory again = readTrajectory(path);
  require(again.size() == trajectory.size(), "no pose is lost");
  for (std::size_t i = 0; i < again.size(); ++i) {
    require(trajectory[i].T_world_body.matrix().allFinite(), "poses are finite");
    require(again[i].stamp_ns == trajectory[i].stamp_ns, "stamps stay");
  }
}

}  // namespace
}  // namespace rotrocc

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rotrocc;
  static const InputFile file(directory() / "poses.txt");
  file.write(asText(data, size));
  try {
    readTimes(file.path());
  } catch (const std::runtime_error&) {
  }
  Trajectory trajectory;
  try {
    detectTrajectoryFormat(file.path());
    trajectory = readTrajectory(file.path());
  } catch (const std::runtime_error&) {
    return 0;
  }
  requireRoundTrip(trajectory);
  return 0;
}
