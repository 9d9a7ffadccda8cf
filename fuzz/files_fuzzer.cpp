// Text files that users write or download. The first byte of an input names its reader.

#include <filesystem>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include "require.h"
#include "rotrocc/parameters.h"
#include "rotrocc/trajectory.h"
#include "sequences/calibration_file.h"
#include "sequences/stereo_sequence.h"
#include "support/parameter_file.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

const TemporaryDirectory& directory() {
  static const TemporaryDirectory directory;
  return directory;
}

/// The path of a file for readers that need one.
std::string write(const std::string& name, std::string_view text) {
  return directory().write(name, std::string(text));
}

/// Whether a reader accepts its file. It says what is wrong by this exception alone.
template <class Error, class Read>
bool accepts(const Read& read) {
  try {
    read();
  } catch (const Error&) {
    return false;
  }
  return true;
}

/// Built only once, because that takes longer than reading a file.
struct Settings {
  Parameters parameters;
  ParameterTable table = makeParameterTable(parameters);
};

/// Parameters that were read can be written, and read again.
void readParameters(std::string_view text) {
  static Settings settings, again;
  const std::string file = write("parameters.yaml", text);
  settings.parameters = {};
  if (!accepts<std::invalid_argument>([&] { loadYaml(file, settings.table); })) return;
  // Reading a file with all parameters takes a hundred times as long as reading a typical input.
  if (std::hash<std::string_view>()(text) % 32 != 0) return;
  const std::string written = toYaml(settings.table);
  again.parameters = {};
  loadYaml(write("parameters.yaml", written), again.table);
  require(toYaml(again.table) == written, "no value is lost");
}

/// A trajectory that was read can be written, and read again.
void readTrajectories(std::string_view text) {
  static const std::string written = directory() / "written.txt";
  const std::string file = write("trajectory.txt", text);
  accepts<std::runtime_error>([&] { readTimes(file); });
  Trajectory trajectory;
  const bool is_trajectory = accepts<std::runtime_error>([&] {
    detectTrajectoryFormat(file);
    trajectory = readTrajectory(file);
  });
  if (!is_trajectory) return;
  {
    TrajectoryWriter writer(written, TrajectoryFormat::kTum);
    for (const StampedPose& pose : trajectory) writer.write(pose);
  }
  const Trajectory again = readTrajectory(written);
  require(again.size() == trajectory.size(), "no pose is lost");
  for (std::size_t i = 0; i < again.size(); ++i) {
    require(trajectory[i].T_world_body.matrix().allFinite(), "poses are finite");
    require(again[i].stamp_ns == trajectory[i].stamp_ns, "stamps stay");
  }
}

/// As a file of camera_calibration, and as a sensor.yaml of the ASL format.
void readCalibrations(std::string_view text) {
  const std::string file = write("calibration.yaml", text);
  accepts<std::runtime_error>([&] {
    const auto info = readCameraInfo(file);
    require(info.width > 0 && info.height > 0, "a camera has pixels");
  });
  accepts<std::runtime_error>([&] {
    const AslCamera read = readAslCamera(file);
    require(read.T_body_camera.matrix().allFinite(), "the pose is finite");
    require(read.camera.width > 0 && read.camera.height > 0, "a camera has pixels");
  });
  accepts<std::runtime_error>(
      [&] { require(readAslPose(file).matrix().allFinite(), "the pose is finite"); });
}

/// calib.txt of a KITTI sequence of one pair.
void readKitti(std::string_view text) {
  static const std::string sequence = [] {
    // PGM is faster to read than PNG, and OpenCV identifies it by its content.
    const std::string image = "P5 6 4 255\n" + std::string(24, '\x80');
    for (const char* folder : {"image_0", "image_1"}) {
      std::filesystem::create_directory(directory() / folder);
      directory().write(folder + std::string("/000000.png"), image);
    }
    directory().write("times.txt", "0\n");
    return directory() / "";
  }();
  write("calib.txt", text);
  accepts<std::runtime_error>(
      [] { openStereoSequence(sequence, {}).calibration.rectified.check(); });
}

const std::map<char, std::function<void(std::string_view)>> kReaders = {
    {'p', readParameters}, {'t', readTrajectories}, {'c', readCalibrations}, {'k', readKitti}};

}  // namespace
}  // namespace rotrocc

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rotrocc;
  if (size == 0) return -1;
  const auto reader = kReaders.find(static_cast<char>(data[0]));
  if (reader == kReaders.end()) return -1;  // not added to the corpus
  reader->second({reinterpret_cast<const char*>(data) + 1, size - 1});
  return 0;
}
