#include "simulation/objects/house.h"

#include <vector>

#include "simulation/objects/facade.h"
#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

constexpr double kFoundation = 4.0;  // [m] below the ground, for houses on slopes

FacadeStyle randomStyle(const HouseSize& size, RandomStream& random) {
  FacadeStyle style;
  style.half_width = 0.5 * size.width;
  style.half_depth = 0.5 * size.depth;
  style.floors = 2 + random.index(3);
  style.floor_height = random.uniform(2.8, 3.3);
  style.window_spacing = random.uniform(2.2, 3.2);
  style.window_width = style.window_spacing * random.uniform(0.38, 0.48);
  style.window_height = random.uniform(1.3, 1.7);
  style.bricks = random.chance(0.3);
  style.wall = style.bricks ? random.uniform(0.3, 0.45) : random.uniform(0.42, 0.8);
  style.frame = random.chance(0.8) ? 0.85 : 0.2;
  style.shutters = random.chance(0.25) ? random.uniform(0.2, 0.4) : 0.0;
  style.shop = random.chance(0.25);
  style.door = random.index(3);
  style.key = randomBits(static_cast<std::uint64_t>(random.uniform(0.0, 1e9)));
  return style;
}

/// A roof over the walls whose ridge runs along the street.
Part makeRoof(const FacadeStyle& style,
              double walls,
              const TextureTiles& tiles,
              RandomStream& random) {
  const double overhang = 0.35;
  const double half_depth = style.half_depth + overhang;
  const double rise = half_depth * random.uniform(0.6, 0.95);
  auto roof = boxBetween({-style.half_width, -walls - rise, -half_depth},
                         {style.half_width, -walls + 0.15, half_depth});
  for (const double side : {-1.0, 1.0}) {
    roof->cut({0.0, -half_depth, side * rise}, {0.0, -walls - rise, 0.0});
  }
  const double mean = random.uniform(0.22, 0.42);
  return {roof, std::make_shared<TexturedMaterial>(tiles.roof_tiles, mean, mean)};
}

Part makeChimney(const FacadeStyle& style,
                 double walls,
                 const TextureTiles& tiles,
                 RandomStream& random) {
  const double x = random.uniform(-0.8, 0.8) * style.half_width;
  const double z = random.uniform(-0.3, 0.3) * style.half_depth;
  const double top = walls + style.half_depth + random.uniform(0.2, 0.8);
  return {boxBetween({x - 0.4, -top, z - 0.3}, {x + 0.4, -walls, z + 0.3}),
          std::make_shared<TexturedMaterial>(tiles.bricks, 0.35, 0.5)};
}

/// A board over the shop windows with a word or two in bright letters.
class ShopSign : public Material {
 public:
  /// Shows line `line` (0 ... 7) of the texture, enlarged to a height of 0.65 m.
  ShopSign(const Texture& texture, int line, double bottom_m, double board)
      : texture_(texture), line_(line), bottom_m_(bottom_m), board_(board) {}

  double reflectance(const SurfacePoint& point) const override {
    TexturePoint words = faceCoordinates(point);
    words.at.y() -= bottom_m_;
    words = scaled(words, 0.125 / 0.65);
    words.at.y() += 0.125 * line_;
    return mix(board_, 0.9, texture_.at(words));
  }

 private:
  const Texture& texture_;
  int line_;
  double bottom_m_;
  double board_;
};

Part makeShopSign(const FacadeStyle& style, const TextureTiles& tiles, RandomStream& random) {
  const double half = random.uniform(0.4, 0.9) * style.half_width;
  const double front = -style.half_depth;
  const int line = random.index(8);
  return {boxBetween({-half, -3.2, front - 0.15}, {half, -2.55, front}),
          std::make_shared<ShopSign>(tiles.writing, line, 2.55, random.uniform(0.08, 0.3))};
}

}  // namespace

Body makeHouse(const HouseSize& size, const TextureTiles& tiles, RandomStream& random) {
  const FacadeStyle style = randomStyle(size, random);
  const double walls = style.floors * style.floor_height + 0.5;
  std::vector<Part> parts = {{boxBetween({-style.half_width, -walls, -style.half_depth},
                                         {style.half_width, kFoundation, style.half_depth}),
                              std::make_shared<Facade>(style, tiles)},
                             makeRoof(style, walls, tiles, random)};
  if (random.chance(0.7)) parts.push_back(makeChimney(style, walls, tiles, random));
  if (style.shop) parts.push_back(makeShopSign(style, tiles, random));
  return Body(std::move(parts));
}

}  // namespace rotrocc
