#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/kitti_camera.h"
#include "rotrocc/stereo_camera.h"
#include "simulation/drives/scenario.h"
#include "simulation/rendering/camera_faults.h"
#include "simulation/stress/lorry.h"

namespace rotrocc {

struct SimulationOptions {
  StereoCamera camera = kittiCamera();
  /// Cameras with the remainders of calibration, sensors, wind and reflections of the real world,
  /// by the seed. They have motion blur and noise of their own: those of `faults` are not used.
  bool worn_rig = false;
  /// Lens of cameras whose images are not rectified: radtan or equidistant; empty: none.
  std::string lens;
  bool gains_out_of_step = false;  ///< each camera exposes for itself
  CameraFaults faults;
  double moving_share = 0.35;  ///< occupied share of the places for moving cars
  LorryPlan lorry;
  double tiled_share = 0.0;  ///< share of all textures that is the same tile everywhere
  double drop_share = 0.0;   ///< share of dropped frames; never the first
  double rate_hz = 10.0;     ///< of scripted drives; recorded ones have stamps
  double duration_s = 0.0;   ///< largest duration; 0: whole drive
  int frames = 0;            ///< largest number of frames; 0: all
  std::uint64_t seed = 1;
  std::uint64_t noise_seed = 1;  ///< of the noise and the exposure jumps of the images

  /// Throws std::invalid_argument on options out of range.
  void check() const;
};

/// Stamps of the frames of a scenario, without those that are dropped.
std::vector<std::int64_t> frameStamps(const Scenario& scenario, const SimulationOptions& options);

}  // namespace rotrocc
