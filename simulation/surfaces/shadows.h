#pragma once

#include <functional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "simulation/scene/scene_geometry.h"

namespace rotrocc {

/// Shadows of all static bodies on the ground, in cells of 0.2 m.
class GroundShadows {
 public:
  /// Where `covers(x, z)` is true; elsewhere there are none.
  GroundShadows(const SceneGeometry& scene, const std::function<bool(double, double)>& covers);

  /// Visible share of the sun at a place on the ground, from 0 to 1.
  double lit(double x, double z) const;

 private:
  Eigen::Vector2d origin_;
  cv::Mat lit_;  // CV_8UC1, rows along z
};

/// Visible share of the sun at the top of a body among all others.
double sunlitTop(const SceneGeometry& scene, const Body& body);

}  // namespace rotrocc
