#include "simulation/scene/ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulation/rows.h"
#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

constexpr double kSampling_m = 2.0;
constexpr double kReach_m = 50.0;     // from the path of the camera, where only it counts
constexpr double kOwn_m = 20.0;       // nearer places have the height of its passage only
constexpr double kClearance_m = 0.4;  // clearance of the camera over the corners of its cell

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

std::vector<double> groundBelow(const GroundGrid& grid,
                                const Path& path,
                                double beyond_m,
                                const std::vector<Path>& others,
                                double below_m) {
  const double neighbour_m = grid.cell_m * std::sqrt(2.0);
  std::vector<Sample> samples;
  append(path, beyond_m, samples);
  const std::size_t own = samples.size();
  for (const Path& other : others) append(other, 0.0, samples);

  std::vector<double> heights(static_cast<std::size_t>(grid.columns + 1) * (grid.rows + 1));
  forEachRow(grid.rows + 1, [&](int row) {
    for (int column = 0; column <= grid.columns; ++column) {
      const Eigen::Vector2d place = grid.origin + grid.cell_m * Eigen::Vector2d(column, row);
      const Passage passage = passageAt(place, samples, own);
      double height = below_m + meanHeight(place, samples, passage);
      // Keeps the camera above the ground where recorded heights rise faster than any road.
      for (std::size_t i = passage.first; i < passage.end; ++i) {
        if ((samples[i].at - place).squaredNorm() > neighbour_m * neighbour_m) continue;
        height = std::max(height, samples[i].height + kClearance_m);
      }
      heights[static_cast<std::size_t>(row) * (grid.columns + 1) + column] = height;
    }
  });
  return heights;
}

}  // namespace rotrocc
