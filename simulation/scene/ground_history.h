#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "simulation/scene/terrain.h"
#include "simulation/street/path.h"

namespace rotrocc {

/// Height of the ground as a function of the camera's position on its path. A recorded drive may
/// revisit a place at another height, since recorded poses drift; the ground then follows each
/// visit. It changes between two visits, and only behind the camera, so that consecutive frames
/// show the same ground.
class GroundHistory {
 public:
  /// The ground lies `below_m` below the path of the camera, which goes on `beyond_m` before its
  /// start and after its end, and below the other paths.
  GroundHistory(const GroundGrid& grid,
                const Path& path,
                double beyond_m,
                const std::vector<Path>& others,
                double below_m);

  /// A ground that never changes, with this height (y) at (x, z).
  GroundHistory(const GroundGrid& grid, const std::function<double(double, double)>& height);

  /// Number of changes before the camera reaches a station.
  std::size_t stage(double station_m) const;

  /// The y coordinate at each corner of the grid, row by row, after the changes of a stage.
  std::vector<double> heights(std::size_t stage) const;

 private:
  struct Change {
    double station_m;
    std::size_t corner;
    double height;
  };

  std::vector<double> first_;    // heights at the start
  std::vector<Change> changes_;  // by station
};

}  // namespace rotrocc
