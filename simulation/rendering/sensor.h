#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

namespace rotrocc {

/// How a camera turns light into grey levels.
struct Sensor {
  double vignetting = 0.15;   ///< relative loss of light in the corners
  double noise_sigma = 2.0;   ///< [grey levels], Gaussian, the same at any brightness
  double full_well_e = 0.0;   ///< electrons of white, with their shot noise; 0: only noise_sigma
  double read_noise_e = 0.0;  ///< [electrons], with full_well_e
};

/// What the light asks of the cameras.
struct Exposure {
  double time_s = 0.0;  ///< 0: that of the rig
  double gain = 1.0;    ///< of the sensor, over that by day: white has so many fewer electrons

  /// The sensor at this gain; one without shot noise gets that of an ordinary sensor.
  Sensor of(Sensor sensor) const;
};

/// Converts brightness (CV_32FC1, 1 is white) times `gain` to a CV_8UC1 image with vignetting and
/// noise, independent for each pixel. The same key gives the same bytes for any number of threads.
cv::Mat develop(const cv::Mat& brightness,
                const Sensor& sensor,
                double gain,
                std::uint64_t noise_key);

}  // namespace rotrocc
