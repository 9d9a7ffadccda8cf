// A calibration, read as a file of camera_calibration and as a sensor.yaml of the ASL format.

#include <stdexcept>

#include "input_file.h"
#include "require.h"
#include "sequences/asl_sensor.h"
#include "sequences/camera_info_calibration.h"
#include "support/temporary_directory.h"

namespace {

/// Readers say what is wrong by this exception alone.
template <class Read>
void tryTo(const Read& read) {
  try {
    read();
  } catch (const std::runtime_error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rotrocc;
  static const TemporaryDirectory directory;
  static const InputFile file(directory / "calibration.yaml");
  file.write(asText(data, size));
  tryTo([&] {
    const auto info = readCameraInfo(file.path());
    require(info.width > 0 && info.height > 0, "a camera has pixels");
  });
  tryTo([&] {
    const AslCamera read = readAslCamera(file.path());
    require(read.T_body_camera.matrix().allFinite(), "the pose is finite");
    require(read.camera.width > 0 && read.camera.height > 0, "a camera has pixels");
  });
  tryTo([&] { require(readAslPose(file.path()).matrix().allFinite(), "the pose is finite"); });
  return 0;
}
