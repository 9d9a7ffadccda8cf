#include "simulation/scene/terrain.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulation/each_row.h"
#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

constexpr double kSampling_m = 2.0;
constexpr double kCameraHeight_m = 1.65;
constexpr double kCell_m = 8.0;  // the ground bends at their borders
constexpr double kMargin_m = 200.0;
constexpr double kReach_m = 50.0;     // from the path of the camera, where only it counts
constexpr double kOwn_m = 20.0;       // nearer places have the height of its passage only
constexpr double kClearance_m = 0.4;  // clearance of the camera over the corners of its cell

GroundGrid gridAround(const std::vector<Path>& paths) {
  Eigen::AlignedBox2d box;
  for (const Path& path : paths) {
    for (double s = 0.0; s < path.length_m() + kSampling_m; s += kSampling_m) {
      const Eigen::Vector3d point = path.position(s);
      box.extend(Eigen::Vector2d(point.x(), point.z()));
    }
  }
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(kMargin_m);
  const Eigen::Vector2d origin = box.min() - margin;
  const Eigen::Vector2d size = box.max() + margin - origin;
  return {kCell_m,
          1.0 / kCell_m,
          origin,
          static_cast<int>(std::ceil(size.x() / kCell_m)),
          static_cast<int>(std::ceil(size.y() / kCell_m))};
}

/// A point of a path: (x, z) and the height.
struct Sample {
  Eigen::Vector2d at;
  double height;
};

/// The section of the camera's path near a place: samples `first` to `end` - 1.
struct Passage {
  std::size_t first = 0;
  std::size_t end = 0;
  double distance_m = std::numeric_limits<double>::infinity();  // minimum
};

void append(const Path& path, double beyond_m, std::vector<Sample>& samples) {
  for (double s = -beyond_m; s < path.length_m() + beyond_m + kSampling_m; s += kSampling_m) {
    const Eigen::Vector3d position = path.position(s);
    samples.push_back({{position.x(), position.z()}, position.y()});
  }
}

Passage passageAt(const Eigen::Vector2d& place,
                  const std::vector<Sample>& samples,
                  std::size_t own) {
  Passage passage;
  for (std::size_t i = 0; i < own; ++i) {
    const double distance = (samples[i].at - place).norm();
    if (distance > kReach_m) continue;
    if (passage.end == 0) passage.first = i;
    passage.end = i + 1;
    passage.distance_m = std::min(passage.distance_m, distance);
  }
  return passage;
}

/// Mean of the samples, by distance. Away from the passage, all other samples contribute as well.
double meanHeight(const Eigen::Vector2d& place,
                  const std::vector<Sample>& samples,
                  const Passage& passage) {
  const double others = smoothStep(kOwn_m, kReach_m, passage.distance_m);
  double sum = 0.0;
  double weights = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double share = i >= passage.first && i < passage.end ? 1.0 : others;
    if (share <= 0.0) continue;
    const double nearness = 1.0 / ((samples[i].at - place).squaredNorm() + 4.0);
    const double weight = share * nearness * nearness;
    sum += weight * samples[i].height;
    weights += weight;
  }
  return sum / weights;
}

}  // namespace

Terrain groundBelow(const Path& path, double beyond_m, const std::vector<Path>& streets) {
  std::vector<Path> paths = streets;
  paths.push_back(path.beside(0.0, beyond_m));
  const GroundGrid grid = gridAround(paths);
  const double neighbor_m = grid.cell_m * std::sqrt(2.0);
  std::vector<Sample> samples;
  append(path, beyond_m, samples);
  const std::size_t own = samples.size();
  for (const Path& street : streets) append(street, 0.0, samples);

  std::vector<double> heights(static_cast<std::size_t>(grid.columns + 1) * (grid.rows + 1));
  eachRow(grid.rows + 1, [&](int row) {
    for (int column = 0; column <= grid.columns; ++column) {
      const Eigen::Vector2d place = grid.origin + grid.cell_m * Eigen::Vector2d(column, row);
      const Passage passage = passageAt(place, samples, own);
      double height = kCameraHeight_m + meanHeight(place, samples, passage);
      // Keeps the camera above the ground where recorded heights rise faster than any road.
      for (std::size_t i = passage.first; i < passage.end; ++i) {
        if ((samples[i].at - place).squaredNorm() > neighbor_m * neighbor_m) continue;
        height = std::max(height, samples[i].height + kClearance_m);
      }
      heights[static_cast<std::size_t>(row) * (grid.columns + 1) + column] = height;
    }
  });
  return {grid, heights};
}

}  // namespace rotrocc
