#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "simulation/street/path.h"

namespace rotrocc {

struct StreetPoint {
  int street = -1;         ///< index of its center line
  double station_m = 0.0;  ///< along the center line
  double right_m = 0.0;    ///< to the right of it
  /// Gradients of station_m and right_m along x and z.
  Eigen::Vector2d station_gradient = Eigen::Vector2d::Zero();
  Eigen::Vector2d right_gradient = Eigen::Vector2d::Zero();
};

class StreetMap {
 public:
  /// Points farther than `reach_m` from all center lines belong to none.
  StreetMap(const std::vector<Path>& center_lines, double reach_m);

  /// Returns false and leaves `point` unchanged if there is no street.
  bool locate(double x, double z, StreetPoint& point) const;

  /// Distance of (x, z) from the nearest center line, at most reach_m [m].
  double distance(double x, double z) const;

 private:
  struct Sample {
    Eigen::Vector2d at, ahead, right;  // (x, z)
    double station_m;
    double curvature_per_m;
    int street;
  };

  void addSamples(const Path& path, int street);
  void makeRaster();
  const Sample* nearestSample(double x, double z) const;
  void markAround(std::int32_t sample, std::vector<float>& squared_distances);

  double reach_m_;
  std::vector<Sample> samples_;
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::int32_t> nearest_;  // sample for each cell of the raster; -1: none in reach
};

}  // namespace rotrocc
