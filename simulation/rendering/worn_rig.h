#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "simulation/rendering/gains.h"
#include "simulation/rendering/lens.h"
#include "simulation/rendering/picture.h"
#include "simulation/rendering/remainder.h"
#include "simulation/rendering/sensor.h"
#include "simulation/surfaces/weather.h"

namespace rotrocc {

/// One camera of a rig as it is in the world: its images are taken by a sensor behind a lens, and
/// rectified by a calibration that leaves something.
class WornCamera {
 public:
  /// The nominal rectified image has the size and focal lengths of `camera`, and the principal
  /// point (cx, camera.cy).
  WornCamera(const StereoCamera& camera,
             double cx,
             const Lens& lens,
             const Remainder& remainder,
             const Sensor& sensor);

  /// Where the pixels of the raw image look; the pinhole camera has its focal lengths.
  const PixelRays& rays() const { return rays_; }

  /// The rectified image of the light on the raw one.
  cv::Mat develop(const cv::Mat& brightness, double gain, std::uint64_t noise_key) const;

 private:
  RawImage raw_;
  Sensor sensor_;
  PixelRays rays_;
};

/// A stereo rig and its surroundings as hard as the real world, different for each seed.
struct WornRig {
  WornCamera left;
  WornCamera right;
  double exposure_s;
  Gains gains;
  Weather weather;
};

WornRig wornRig(const StereoCamera& camera, std::uint64_t seed, const Exposure& exposure = {});

}  // namespace rotrocc
