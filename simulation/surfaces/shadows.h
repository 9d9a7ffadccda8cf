#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "simulation/scene/scene_geometry.h"
#include "simulation/street/street_map.h"

namespace rotrocc {

/// Shadows of all static bodies on the ground, in cells of 0.2 m.
class GroundShadows {
 public:
  /// Those within 14 m of the center line of a street.
  GroundShadows(const SceneGeometry& scene, const StreetMap& streets);

  /// Visible share of the sun at a place on the ground.
  double lit(double x, double z) const;

 private:
  Eigen::Vector2d origin_;
  cv::Mat lit_;  // CV_8UC1, rows along z
};

/// Visible share of the sun at the top of a body among all others.
double sunlitTop(const SceneGeometry& scene, const Body& body);

}  // namespace rotrocc
