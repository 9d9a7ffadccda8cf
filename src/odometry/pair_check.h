#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Why a pair cannot be used, in one sentence with the value. None if it can: the camera is valid,
/// images and masks are CV_8UC1 and of its size, and the stamp is later than `newest_ns`, that of
/// the pair before, if there was one.
std::optional<std::string> whyUnusable(const StereoPair& pair,
                                       const StereoCamera& camera,
                                       const std::optional<std::int64_t>& newest_ns);

/// Why a usable pair cannot be compared with the one before, in one sentence; none if it can:
/// there is one, not more than `max_gap_s` ago, of a camera that differs by no more than a refined
/// calibration.
std::optional<std::string> whyRestart(const StereoPair& pair,
                                      const StereoCamera& camera,
                                      const std::optional<std::int64_t>& newest_ns,
                                      const StereoCamera& camera_before,
                                      double max_gap_s);

}  // namespace rotrocc
