#include "simulation/objects/objects.h"

#include <cmath>
#include <utility>
#include <vector>

namespace rotrocc {
namespace {

/// Leaves, and the same pattern enlarged `twigs` times to twigs for larger distances. The darkest
/// parts are holes, which fade out with distance.
Material foliage(const TextureTiles& tiles, double mean, double twigs, double hole_limit) {
  const auto pattern = [&tiles, twigs](const TexturePoint& at) {
    return 0.45 * tiles.leaves.at(at) + 0.55 * tiles.leaves.at(scaled(at, 1.0 / twigs));
  };
  const auto isHole =
      [=](const Eigen::Vector3d& position, const Eigen::Vector3d& normal, double pixel_m) {
        const Eigen::Vector3d no_spread = Eigen::Vector3d::Zero();
        TexturePoint at = faceCoordinates({position, normal, no_spread, no_spread});
        at.per_column = {pixel_m, 0.0};
        at.per_row = {0.0, pixel_m};
        return pattern(at) < hole_limit;
      };
  Material leaves = {[=](const SurfacePoint& point) {
    return mean * (0.1 + 1.9 * pattern(faceCoordinates(point)));
  }};
  if (hole_limit > 0.0) leaves.is_hole = isHole;
  leaves.is_tangle = true;
  return leaves;
}

Part makeTrunk(double height, double radius, const TextureTiles& tiles) {
  return {cylinder(1, Eigen::Vector3d(0.0, -0.5 * height + 0.2, 0.0), radius, 0.5 * height + 0.2),
          textured(tiles.bark, 0.22, 0.35)};
}

}  // namespace

Body makeTree(const TextureTiles& tiles, RandomStream& random) {
  const double trunk = random.uniform(2.2, 3.0);
  const double reach = random.uniform(1.3, 1.9);
  const Material leaves = foliage(tiles, random.uniform(0.3, 0.44), 2.3, 0.39);
  std::vector<Part> parts = {makeTrunk(trunk + 0.6, random.uniform(0.11, 0.19), tiles)};
  parts.push_back(
      {ellipsoid({0.0, -trunk - 0.9 * reach, 0.0}, {0.85 * reach, 0.9 * reach, 0.85 * reach}),
       leaves});
  const int balls = 9 + random.index(3);
  for (int i = 0; i < balls; ++i) {
    const double angle = 2.0 * M_PI * (i + random.uniform(0.0, 0.7)) / balls;
    const double away = reach * random.uniform(0.45, 0.85);
    const double size = reach * random.uniform(0.38, 0.6);
    const double height = trunk + reach * random.uniform(0.35, 1.9);
    parts.push_back({ellipsoid({away * std::cos(angle), -height, away * std::sin(angle)},
                               {size, 0.85 * size, size}),
                     leaves});
  }
  return Body(std::move(parts));
}

Body makeForestTree(const TextureTiles& tiles, RandomStream& random) {
  const double height = random.uniform(9.0, 17.0);
  const double reach = random.uniform(2.2, 3.8);
  const Material leaves = foliage(tiles, random.uniform(0.17, 0.34), 6.0, 0.36);
  std::vector<Part> parts = {makeTrunk(0.5 * height, 0.25, tiles)};
  constexpr int kBalls = 7;
  for (int i = 0; i < kBalls; ++i) {
    const double share = (i + random.uniform(0.1, 0.9)) / kBalls;
    const double size = reach * random.uniform(0.4, 0.65) * (1.2 - 0.7 * share);
    const double angle = random.uniform(0.0, 2.0 * M_PI);
    const double away = 0.55 * reach * (1.0 - 0.8 * share);
    parts.push_back(
        {ellipsoid({away * std::cos(angle), -height * (0.25 + 0.7 * share), away * std::sin(angle)},
                   {size, random.uniform(0.11, 0.17) * height, size}),
         leaves});
  }
  return Body(std::move(parts));
}

Body makeHedge(double length_m, const TextureTiles& tiles, RandomStream& random) {
  const double height = random.uniform(1.0, 1.7);
  auto solid = std::make_shared<ConvexSolid>(Eigen::AlignedBox3d(
      Eigen::Vector3d(-0.5 * length_m, -height, -0.4), Eigen::Vector3d(0.5 * length_m, 0.5, 0.4)));
  for (const double side : {-1.0, 1.0})
    solid->cut({0.0, -0.5, side}, {0.0, -height + 0.1, side * 0.4});
  return Body({{solid, foliage(tiles, random.uniform(0.2, 0.32), 2.3, 0.0)}});
}

}  // namespace rotrocc
