#include "simulation/surfaces/sky.h"

#include <algorithm>
#include <cmath>

#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

constexpr double kHillTop = 0.09;  // tangent of the highest elevation

double clouds(const TextureTiles& tiles,
              const Eigen::Vector3d& direction,
              const PixelSpread& spread) {
  const double up = std::max(-direction.y() / direction.norm(), 0.0) + 0.12;
  const double scale = 0.11 / (up * direction.norm());
  const TexturePoint at = {scale * Eigen::Vector2d(direction.x(), direction.z()),
                           scale * Eigen::Vector2d(spread.per_column.x(), spread.per_column.z()),
                           scale / up * Eigen::Vector2d(spread.per_row.y(), spread.per_row.z())};
  const double cover = smoothStep(0.4, 0.75, tiles.blotches.at(at));
  const double clear = mix(0.98, 0.72, smoothStep(0.12, 0.7, up));
  return mix(clear, 1.04, cover);
}

}  // namespace

double skyBrightness(const TextureTiles& tiles,
                     const Eigen::Vector3d& direction,
                     const PixelSpread& spread) {
  const double level = std::sqrt(direction.x() * direction.x() + direction.z() * direction.z());
  const double elevation = -direction.y() / level;
  if (elevation > kHillTop) return clouds(tiles, direction, spread);

  const double pixel = spread.per_row.norm() / level;
  const double azimuth = std::atan2(direction.x(), direction.z()) / (2.0 * M_PI);
  const auto ridge = [&](double row, double cycles) {
    return tiles.blotches.at({{cycles * azimuth, row}, {cycles * pixel, 0.0}, {0.0, 1e-6}});
  };
  const double far_top = 0.015 + 0.10 * (ridge(0.3, 1.0) - 0.25);
  const double far_share = 1.0 - coverageAbove(far_top, elevation, pixel);
  const double sky = far_share < 1.0 ? clouds(tiles, direction, spread) : 0.0;
  const double near_top = -0.005 + 0.045 * (ridge(0.7, 2.0) - 0.25) + 0.012 * ridge(0.1, 24.0);
  const double near_share = 1.0 - coverageAbove(near_top, elevation, pixel);
  if (far_share <= 0.0 && near_share <= 0.0) return sky;
  const TexturePoint woods = {
      {48.0 * azimuth, 8.0 * elevation}, {8.0 * pixel, 0.0}, {0.0, 8.0 * pixel}};
  const double trees = tiles.leaves.at(woods) - 0.45;
  const double behind = mix(sky, 0.52 + 0.08 * trees, far_share);
  return mix(behind, 0.30 + 0.18 * trees, near_share);
}

}  // namespace rotrocc
