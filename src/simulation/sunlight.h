#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "simulation/scene_geometry.h"
#include "simulation/street_map.h"

namespace rotrocc {

/// Direction to the sun, of unit length: behind the viewer at the start, to the left.
Eigen::Vector3d directionToSun();

/// The light that falls on a surface; `sunlit` is how much of the sun reaches it, from 0 to 1.
double illumination(const Eigen::Vector3d& normal, double sunlit);

/// The shadows that all standing bodies cast on the ground beside the streets.
class SunShadows {
 public:
  /// Looks at what is within `reach_m` of the centre lines.
  SunShadows(const SceneGeometry& scene, const StreetMap& streets, double reach_m);

  /// How much of the sun reaches a place on the ground, from 0 to 1.
  double sunlit(double x, double z) const;

 private:
  Eigen::Vector2d origin_;
  cv::Mat sunlit_;  // CV_8UC1, rows along z
};

/// How much of the sun reaches the top of a body, given everything that stands around it.
double sunlitTop(const SceneGeometry& scene, const Body& body);

}  // namespace rotrocc
