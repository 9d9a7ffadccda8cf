#pragma once

#include <functional>
#include <optional>
#include <string>

#include "features/stereo_frame.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Why a pair cannot be used, in one sentence with the value. None if it can: the camera is valid,
/// images and masks are CV_8UC1 and of its size.
std::optional<std::string> whyUnusable(const StereoPair& pair, const StereoCamera& camera);

/// Why a usable pair cannot be compared with the newest frame, in one sentence; none if it can:
/// there is one, not many periods before or after, of a camera that differs by no more than a
/// refined calibration. `period_s` is 0 before the second pair.
std::optional<std::string> whyRestart(const StereoPair& pair,
                                      const StereoCamera& camera,
                                      const StereoFrame* newest,
                                      const StereoCamera& camera_before,
                                      double period_s);

/// Why a later pair, with its frame, is not a measurement, in one sentence: an image shows
/// something, and is identical to the same side's image of the newest frame, at the largest size
/// that both frames have. A stationary camera's images differ by their noise.
std::optional<std::string> whyRepeated(const StereoPair& pair,
                                       const StereoFrame& current,
                                       const StereoFrame& newest,
                                       const std::function<bool()>& may_repeat);

}  // namespace rotrocc
