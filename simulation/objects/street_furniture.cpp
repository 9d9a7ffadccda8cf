#include "simulation/objects/objects.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

Part makePost(double height, double radius, double reflectance) {
  return {cylinder(1, Eigen::Vector3d(0.0, -0.5 * height + 0.1, 0.0), radius, 0.5 * height + 0.1),
          plain(reflectance)};
}

/// A dark ring around a bright face with a dark mark, as on prohibitory signs.
Material roundSign(double sign_height, bool bar) {
  return {[=](const SurfacePoint& point) {
    if (point.normal.z() > -0.5) return 0.35;
    const TexturePoint at = faceCoordinates(point);
    const double x = at.at.x();
    const double y = at.at.y() - sign_height;
    const double width = at.pixelWidth();
    const double face = 1.0 - coverageAbove(0.23, std::hypot(x, y), width);
    const double mark = bar ? coverageBetween(-0.17, 0.17, x, width) *
                                  coverageBetween(-0.05, 0.05, y, at.pixelHeight())
                            : coveragePeriodic(0.12, 0.06, x + 0.03, width) *
                                  coverageBetween(-0.11, 0.11, y, at.pixelHeight()) *
                                  coverageBetween(-0.15, 0.15, x, width);
    return mix(0.22, mix(bar ? 0.22 : 0.9, bar ? 0.9 : 0.05, mark), face);
  }};
}

/// Lines of writing on a board.
Material writing(const Texture& texture, double board, double letters, double line_m) {
  return {[=, &texture](const SurfacePoint& point) {
    if (point.normal.z() > -0.5) return 0.3;
    return mix(board, letters, texture.at(scaled(faceCoordinates(point), 0.125 / line_m)));
  }};
}

/// Corrugated steel with stains, and at its left end the bolts of a joint.
Material railMaterial(const Texture& stains, double left_end) {
  return {[&stains, left_end](const SurfacePoint& point) {
    const TexturePoint at = faceCoordinates(point);
    const double ridges = coveragePeriodic(0.155, 0.08, at.at.y(), at.pixelHeight());
    const double along = at.at.x() - left_end;
    const double joint = coverageBetween(0.0, 0.35, along, at.pixelWidth());
    const double bolts = joint * coveragePeriodic(0.12, 0.05, along, at.pixelWidth()) *
                         coveragePeriodic(0.11, 0.05, at.at.y(), at.pixelHeight());
    const double stain = 1.6 * (stains.at(scaled(at, 0.7)) - 0.5);
    return mix((0.38 + 0.22 * ridges) * (1.0 + stain - 0.25 * joint), 0.1, bolts);
  }};
}

}  // namespace

Body makeLamp() {
  constexpr double kHeight = 6.5;
  return Body({makePost(kHeight, 0.07, 0.3),
               makePost(1.1, 0.11, 0.25),
               {cylinder(2, Eigen::Vector3d(0.0, -kHeight, -0.7), 0.04, 0.75), plain(0.3)},
               {ellipsoid(Eigen::Vector3d(0.0, -kHeight, -1.6), Eigen::Vector3d(0.14, 0.09, 0.38)),
                plain(0.65)}});
}

Body makeSign(const TextureTiles& tiles, RandomStream& random) {
  const double height = random.uniform(2.2, 2.6);
  std::vector<Part> parts = {makePost(height, 0.035, 0.45)};
  if (random.chance(0.6)) {
    const bool bar = random.chance(0.5);
    parts.push_back(
        {cylinder(2, Eigen::Vector3d(0.0, -height, -0.06), 0.3, 0.015), roundSign(height, bar)});
  } else {
    const double half = random.uniform(0.3, 0.55);
    parts.push_back({boxBetween({-half, -height - 0.25, -0.08}, {half, -height + 0.25, -0.05}),
                     writing(tiles.writing, 0.85, 0.1, 0.2)});
  }
  return Body(std::move(parts));
}

Body makeKerb(double length_m, const TextureTiles& tiles, RandomStream& random) {
  const double tone = random.uniform(0.38, 0.58);
  auto stone =
      boxBetween({-0.5 * length_m + 0.01, -0.12, -0.12}, {0.5 * length_m - 0.01, 0.3, 0.12});
  stone->cut({0.0, -1.0, -1.0}, {0.0, -0.1, -0.12});
  return Body({{stone, textured(tiles.plaster, tone, tone)}});
}

Body makeGuardRail(double length_m, const TextureTiles& tiles) {
  const double half = 0.5 * length_m;
  return Body(
      {{boxBetween({-half, -0.75, -0.04}, {half, -0.44, 0.04}), railMaterial(tiles.plaster, -half)},
       {boxBetween({-0.06, -0.72, 0.04}, {0.06, 0.3, 0.14}), plain(0.35)}});
}

Body makeBin(RandomStream& random) {
  const double height = random.uniform(0.8, 1.1);
  return Body({makePost(height, random.uniform(0.2, 0.28), random.uniform(0.08, 0.3))});
}

Body makeGantry(double half_width_m, const TextureTiles& tiles, RandomStream& random) {
  std::vector<Part> parts = {
      {boxBetween({-half_width_m, -7.2, -0.3}, {half_width_m, -6.7, 0.3}), plain(0.4)}};
  for (const double side : {-1.0, 1.0}) {
    const double x = side * half_width_m;
    parts.push_back({boxBetween({x - 0.25, -7.2, -0.25}, {x + 0.25, 0.5, 0.25}), plain(0.42)});
  }
  for (const double center : {-0.45, 0.15}) {
    const double x = half_width_m * (center + random.uniform(0.0, 0.2));
    const double half = random.uniform(1.6, 2.3);
    parts.push_back({boxBetween({x - half, -8.4, -0.45}, {x + half, -5.7, -0.32}),
                     writing(tiles.writing, 0.16, 0.95, 0.6)});
  }
  return Body(std::move(parts));
}

}  // namespace rotrocc
