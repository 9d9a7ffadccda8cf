#pragma once

#include <functional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "simulation/scene/light.h"
#include "simulation/scene/scene_geometry.h"
#include "simulation/surfaces/lighting.h"

namespace rotrocc {

/// The sun and the sky.
class Daylight : public Light {
 public:
  explicit Daylight(const Lighting& lighting) : lighting_(lighting) {}

  double illumination(const Eigen::Vector3d& position,
                      const Eigen::Vector3d& normal,
                      double share) const override;
  double reaching(const SceneGeometry& scene, const Eigen::Vector3d& position) const override;

 private:
  Lighting lighting_;
};

/// Shadows of all static bodies on the ground.
class GroundShadows {
 public:
  /// In cells of `cell_m`, where `covers(x, z)` is true; elsewhere there are none.
  GroundShadows(const SceneGeometry& scene,
                const Light& light,
                double cell_m,
                const std::function<bool(double, double)>& covers);

  /// Visible share of the direct light at a place on the ground, from 0 to 1.
  double lit(double x, double z) const;

 private:
  double cell_m_;
  Eigen::Vector2d origin_;
  cv::Mat lit_;  // CV_8UC1, rows along z
};

/// Visible share of the direct light at the top of a body among all others.
double litTop(const SceneGeometry& scene, const Light& light, const Body& body);

}  // namespace rotrocc
