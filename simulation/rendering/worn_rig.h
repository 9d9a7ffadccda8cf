#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "simulation/rendering/picture.h"
#include "simulation/rendering/sensor.h"
#include "simulation/surfaces/weather.h"

namespace rotrocc {

/// A gain that swings between two values.
struct GainSwing {
  double low;
  double high;
  double period_s;
  double phase_rad;

  double at(double time_s) const;
};

/// Gains of the cameras of a rig over time: of what they see in common, and of each for itself.
struct Gains {
  GainSwing common;
  GainSwing left;
  GainSwing right;

  double at(double time_s, bool of_right) const {
    return common.at(time_s) * (of_right ? right : left).at(time_s);
  }
};

/// One camera of a rig as it is in the world: its images are taken by a sensor behind a lens, and
/// rectified by a calibration that leaves something.
struct WornCamera {
  PixelRays rays;     ///< of the pixels of the raw image
  cv::Mat raw_place;  ///< CV_32FC2: place in the raw image of each rectified pixel
  Sensor sensor;

  /// The rectified image of the light on the raw one.
  cv::Mat develop(const cv::Mat& brightness, double gain, std::uint64_t noise_key) const;
};

/// A stereo rig and its surroundings as hard as the real world, different for each seed. The
/// nominal rectified images are those of `camera`.
struct WornRig {
  WornCamera left;
  WornCamera right;
  double exposure_s;
  Gains gains;
  Weather weather;
};

WornRig wornRig(const StereoCamera& camera, std::uint64_t seed, const Exposure& exposure = {});

}  // namespace rotrocc
