#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "simulation/scene/scene_geometry.h"
#include "simulation/street/street_map.h"

namespace rotrocc {

/// Shadows of all static bodies on the ground beside the streets.
class SunShadows {
 public:
  /// Covers the ground within `reach_m` of the centre lines.
  SunShadows(const SceneGeometry& scene, const StreetMap& streets, double reach_m);

  /// Visible share of the sun at a place on the ground, from 0 to 1.
  double sunlit(double x, double z) const;

 private:
  Eigen::Vector2d origin_;
  cv::Mat sunlit_;  // CV_8UC1, rows along z
};

/// Visible share of the sun at the top of a body among all others.
double sunlitTop(const SceneGeometry& scene, const Body& body);

}  // namespace rotrocc
