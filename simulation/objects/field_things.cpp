#include "simulation/objects/field_things.h"

#include <cmath>
#include <utility>
#include <vector>

namespace rotrocc {

Body makeStone(const TextureTiles& tiles, RandomStream& random) {
  const double size = 0.06 + 0.45 * std::pow(random.uniform(0.0, 1.0), 4.0);
  const double tone = random.uniform(0.3, 0.6);
  const Eigen::Vector3d half_axes(0.5 * size * random.uniform(0.8, 1.4),
                                  0.5 * size * random.uniform(0.6, 1.0),
                                  0.5 * size * random.uniform(0.8, 1.4));
  const Eigen::Vector3d centre(0.0, -0.3 * half_axes.y(), 0.0);
  return Body({{std::make_shared<Ellipsoid>(centre, half_axes),
                std::make_shared<TexturedMaterial>(tiles.asphalt, tone, tone)}});
}

Body makeFence(double length_m, const TextureTiles& tiles, RandomStream& random) {
  const auto wood = std::make_shared<TexturedMaterial>(tiles.bark, random.uniform(0.25, 0.4), 0.5);
  std::vector<Part> parts = {
      {std::make_shared<Cylinder>(1, Eigen::Vector3d(-0.5 * length_m, -0.5, 0.0), 0.06, 0.7),
       wood}};
  for (const double height : {0.55, 1.0}) {
    const double sag = random.uniform(-0.04, 0.04);
    parts.push_back({std::make_shared<Cylinder>(
                         0, Eigen::Vector3d(0.0, -height + sag, 0.0), 0.04, 0.5 * length_m + 0.05),
                     wood});
  }
  return Body(std::move(parts));
}

}  // namespace rotrocc
