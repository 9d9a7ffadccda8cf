// Two serialized sensor_msgs/CameraInfo: validation and conversion to a camera.

#include <cmath>

#include "input/camera_validation.h"
#include "input/input_error.h"
#include "message_reader.h"
#include "require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rotrocc;
  MessageReader reader(data, size);
  const auto left = reader.cameraInfo();
  if (!left) return -1;  // not added to the corpus
  const auto right = reader.cameraInfo();
  if (!right) return -1;
  for (const double baseline_m : {0.0, 0.5}) {
    try {
      const StereoCamera camera = toStereoCamera(*left, *right, baseline_m);
      oddityOf(camera);
      camera.check();
      require(camera == toStereoCamera(*left, *right, baseline_m), "a camera is like itself");
      require(std::isfinite(camera.disparityAtInfinity()), "the disparity at infinity is finite");
    } catch (const InputError&) {
    }
  }
  return 0;
}
