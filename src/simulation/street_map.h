#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "simulation/path.h"

namespace rotrocc {

/// A place on the ground as seen from the nearest street.
struct StreetPoint {
  int street = -1;         ///< index of its centre line
  double station_m = 0.0;  ///< along the centre line
  double right_m = 0.0;    ///< to the right of it
  /// How station_m and right_m grow per metre along x and z.
  Eigen::Vector2d station_gradient = Eigen::Vector2d::Zero();
  Eigen::Vector2d right_gradient = Eigen::Vector2d::Zero();
};

/// Finds the street a point of the ground belongs to.
class StreetMap {
 public:
  /// Points farther than `reach_m` from all centre lines belong to none.
  StreetMap(const std::vector<Path>& centre_lines, double reach_m);

  /// Returns false, and leaves `point` alone, where there is no street.
  bool locate(double x, double z, StreetPoint& point) const;

  /// How far (x, z) is from the nearest centre line, reach_m at most [m].
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
  Eigen::Vector2d origin_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::int32_t> nearest_;  // sample for each cell of the raster; -1: none in reach
};

}  // namespace rotrocc
