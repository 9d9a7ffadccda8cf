#pragma once

#include <vector>

#include <Eigen/Geometry>

namespace rotrocc {

/// What lights the world. A brightness is that of a white surface, 1 is white on a picture.
struct Lighting {
  double sun = 0.8;           ///< on a surface that faces it
  double ambient = 0.36;      ///< of the sky, on level ground
  double sky = 1.0;           ///< brightness of the sky itself, relative to that of a fine day
  double street_lamps = 0.0;  ///< on the ground below a lamp
  double lights = 0.0;        ///< of windows, lamps and the lights of cars; 0: off
  double head_lamps = 0.0;    ///< of the own car, on a white wall 10 m ahead; 0: off
};

/// A clear night in a lit street, as cameras see it that expose for that.
Lighting nightLighting();

/// Direction to the sun, of unit length: behind the viewer at the start, to the left.
const Eigen::Vector3d& directionToSun();

/// Light of sun and sky on a surface; `sunlit` is the visible share of the sun, from 0 to 1.
double daylight(const Lighting& lighting, const Eigen::Vector3d& normal, double sunlit);

/// Light of the dipped beams of the own car on a surface in the axes of its left camera: 1 on a
/// white wall 10 m ahead. They cast no shadows.
double headLight(const Eigen::Vector3d& position, const Eigen::Vector3d& normal);

/// Light of street lamps at these places on a surface, all in the axes of the world: 1 on level
/// ground right below a lamp of 6.5 m. It passes through everything.
double streetLight(const std::vector<Eigen::Vector3d>& lamps,
                   const Eigen::Vector3d& position,
                   const Eigen::Vector3d& normal);

}  // namespace rotrocc
