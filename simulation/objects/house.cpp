#include "simulation/objects/objects.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

constexpr double kFoundation = 4.0;  // [m] below the ground, for houses on slopes

/// Lengths in meters, brightnesses as reflectances.
struct FacadeStyle {
  double half_width, half_depth;  // the front is wide
  int floors;
  double floor_height;
  double window_spacing, window_width, window_height;
  double wall, frame;
  double shutters;  // their brightness; 0: none
  bool bricks;
  bool shop;  // large panes on the ground floor
  int door;   // column of windows that it replaces
  std::uint64_t key;
};

constexpr double kSill_m = 0.9;  // height of the windows above their floor

/// The walls of a house: windows with frames, sills and panes of different brightness, a door or a
/// shop, a plinth and ledges between the floors.
class Facade {
 public:
  Facade(const FacadeStyle& style, const TextureTiles& tiles)
      : style_(style),
        tiles_(tiles),
        front_half_row_(halfRow(style.half_width)),
        side_half_row_(halfRow(style.half_depth)) {}

  double operator()(const SurfacePoint& point) const {
    const Place place = placeOf(point);
    double brightness = wall(place);
    brightness = withLedges(place, brightness);
    brightness = withWindows(place, brightness);
    return withGroundFloor(place, brightness);
  }

 private:
  /// Position of a pixel relative to the windows of its wall.
  struct Place {
    TexturePoint point;
    double u, v;           // from the left lower corner of the first window's cell [m]
    double width, height;  // of the pixel [m]
    double windows;        // share of the pixel on the part of the wall that has windows
    double column, row;    // of the window
    double resolved;       // 1: single windows are resolved, 0: they are not
  };

  double halfRow(double half_wall) const {
    const double columns =
        std::max(1.0, std::floor((2.0 * half_wall - 0.6) / style_.window_spacing));
    return 0.5 * columns * style_.window_spacing;
  }

  Place placeOf(const SurfacePoint& point) const {
    Place place;
    place.point = faceCoordinates(point);
    place.width = std::max(1.2 * place.point.width(0), 1e-4);
    place.height = std::max(1.2 * place.point.width(1), 1e-4);
    const bool front = std::abs(point.normal.z()) > std::abs(point.normal.x());
    const double half_row = front ? front_half_row_ : side_half_row_;
    place.u = place.point.at.x() + half_row;
    place.v = place.point.at.y();
    place.windows =
        coverageBetween(0.0, 2.0 * half_row, place.u, place.width) *
        coverageBetween(0.0, style_.floors * style_.floor_height, place.v, place.height);
    place.column = std::floor(place.u / style_.window_spacing);
    place.row = std::floor(place.v / style_.floor_height);
    place.resolved = 1.0 - smoothStep(0.3, 0.6, place.width / style_.window_spacing);
    return place;
  }

  double wall(const Place& place) const {
    const double grain = style_.bricks ? 0.9 * (tiles_.bricks.at(place.point) - 0.56)
                                       : 0.5 * (tiles_.plaster.at(place.point) - 0.5);
    const double damp = 0.8 + 0.2 * smoothStep(0.0, 1.5, place.v);
    return style_.wall * damp * (1.0 + grain);
  }

  double withLedges(const Place& place, double brightness) const {
    const double plinth = 1.0 - coverageAbove(0.55, place.v, place.height);
    brightness = mix(brightness, 0.55 * brightness, plinth);
    const double upper = coverageAbove(0.5 * style_.floor_height, place.v, place.height);
    const double ledge = upper * coveragePeriodic(style_.floor_height, 0.14, place.v, place.height);
    const double shade =
        upper * coveragePeriodic(style_.floor_height, 0.1, place.v + 0.1, place.height);
    return mix(mix(brightness, 0.5 * brightness, shade), 1.15 * brightness, ledge);
  }

  double windowCoverage(const Place& place, double margin_m) const {
    const double left = 0.5 * (style_.window_spacing - style_.window_width) - margin_m;
    const double bottom = kSill_m - margin_m;
    return place.windows *
           coveragePeriodic(style_.window_spacing,
                            style_.window_width + 2.0 * margin_m,
                            place.u - left,
                            place.width) *
           coveragePeriodic(style_.floor_height,
                            style_.window_height + 2.0 * margin_m,
                            place.v - bottom,
                            place.height);
  }

  double pane(const Place& place) const {
    const auto column = static_cast<std::uint64_t>(static_cast<std::int64_t>(place.column));
    const auto row = static_cast<std::uint64_t>(static_cast<std::int64_t>(place.row));
    const double luck = randomUniform(style_.key, column, row);
    const double v = place.v - place.row * style_.floor_height - kSill_m;
    const double reflection =
        0.22 * tiles_.blotches.at({0.17 * place.point.at + Eigen::Vector2d(0.37 * luck, 0.0),
                                   0.17 * place.point.per_column,
                                   0.17 * place.point.per_row});
    const double curtain_edge = style_.window_height * (luck < 0.5 ? 0.0 : 1.7 * (luck - 0.5));
    const double curtain = luck > 0.85 ? 0.0 : 1.0 - coverageAbove(curtain_edge, v, place.height);
    const double single = mix(0.04 + reflection, 0.42, curtain);
    const double lintel = coverageAbove(style_.window_height - 0.12, v, place.height);
    return mix(0.2, mix(single, 0.03, lintel), place.resolved);
  }

  double withWindows(const Place& place, double brightness) const {
    const double spacing = style_.window_spacing;
    if (style_.shutters > 0.0) {
      const double half = 0.5 * style_.window_width;
      const double shutter_left = 0.5 * spacing - 2.0 * half;
      const double beside =
          coveragePeriodic(spacing, 4.0 * half, place.u - shutter_left, place.width) *
          coveragePeriodic(
              style_.floor_height, style_.window_height, place.v - kSill_m, place.height);
      const double slats = 0.75 + 0.5 * coveragePeriodic(0.12, 0.06, place.v, place.height);
      brightness = mix(brightness, style_.shutters * slats, beside * place.windows);
    }
    const double frame = windowCoverage(place, 0.1);
    if (frame <= 0.0) return brightness;
    brightness = mix(brightness, style_.frame, frame);
    const double bar =
        coveragePeriodic(spacing, 0.07, place.u - 0.5 * spacing + 0.035, place.width);
    const double crossbar = coveragePeriodic(
        style_.floor_height, 0.06, place.v - kSill_m - 0.68 * style_.window_height, place.height);
    const double glass = windowCoverage(place, 0.0) * (1.0 - bar) * (1.0 - crossbar);
    return mix(brightness, pane(place), glass);
  }

  double withGroundFloor(const Place& place, double brightness) const {
    const double spacing = style_.window_spacing;
    if (style_.shop) {
      const double shop = place.windows * coverageBetween(0.0, 2.9, place.v, place.height);
      if (shop <= 0.0) return brightness;
      const double glass =
          coveragePeriodic(2.0 * spacing, 2.0 * spacing - 0.3, place.u - 0.15, place.width) *
          coverageBetween(0.45, 2.35, place.v, place.height);
      const double shelves = coveragePeriodic(0.48, 0.05, place.v, place.height);
      const double things = tiles_.bricks.at(scaled(place.point, 0.6));
      const double goods = mix(0.5 * things * things, 0.35, shelves);
      return mix(brightness, mix(0.45 * style_.wall, goods, glass), shop);
    }
    constexpr double kDoor_m = 2.75;  // the highest of what follows
    if (place.v - 0.5 * place.height >= kDoor_m) return brightness;
    const double center = (style_.door + 0.5) * spacing;
    const auto area = [&](double half, double top) {
      return coverageBetween(center - half, center + half, place.u, place.width) *
             coverageBetween(0.0, top, place.v, place.height);
    };
    brightness = mix(brightness, style_.wall * 0.9, area(0.5 * spacing - 0.1, kDoor_m));
    brightness = mix(brightness, style_.frame, area(0.68, 2.45));
    brightness = mix(brightness, 0.16, area(0.55, 2.3));
    const double panels = coveragePeriodic(0.7, 0.5, place.v - 0.15, place.height);
    return mix(brightness, 0.24, panels * area(0.38, 2.1));
  }

  FacadeStyle style_;
  const TextureTiles& tiles_;
  double front_half_row_;  // half of the width of all windows in a row [m]
  double side_half_row_;
};

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

/// Its ridge runs along the street.
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
  return {roof, textured(tiles.roof_tiles, mean, mean)};
}

Part makeChimney(const FacadeStyle& style,
                 double walls,
                 const TextureTiles& tiles,
                 RandomStream& random) {
  const double x = random.uniform(-0.8, 0.8) * style.half_width;
  const double z = random.uniform(-0.3, 0.3) * style.half_depth;
  const double top = walls + style.half_depth + random.uniform(0.2, 0.8);
  return {boxBetween({x - 0.4, -top, z - 0.3}, {x + 0.4, -walls, z + 0.3}),
          textured(tiles.bricks, 0.35, 0.5)};
}

/// A board over the shop windows with a word or two in bright letters: line `line` (0 ... 7) of the
/// texture, enlarged to a height of 0.65 m.
Material shopSign(const Texture& texture, int line, double bottom_m, double board) {
  return {[=, &texture](const SurfacePoint& point) {
    TexturePoint words = faceCoordinates(point);
    words.at.y() -= bottom_m;
    words = scaled(words, 0.125 / 0.65);
    words.at.y() += 0.125 * line;
    return mix(board, 0.9, texture.at(words));
  }};
}

Part makeShopSign(const FacadeStyle& style, const TextureTiles& tiles, RandomStream& random) {
  const double half = random.uniform(0.4, 0.9) * style.half_width;
  const double front = -style.half_depth;
  const int line = random.index(8);
  return {boxBetween({-half, -3.2, front - 0.15}, {half, -2.55, front}),
          shopSign(tiles.writing, line, 2.55, random.uniform(0.08, 0.3))};
}

}  // namespace

Body makeHouse(const HouseSize& size, const TextureTiles& tiles, RandomStream& random) {
  const FacadeStyle style = randomStyle(size, random);
  const double walls = style.floors * style.floor_height + 0.5;
  std::vector<Part> parts = {{boxBetween({-style.half_width, -walls, -style.half_depth},
                                         {style.half_width, kFoundation, style.half_depth}),
                              {Facade(style, tiles)}},
                             makeRoof(style, walls, tiles, random)};
  if (random.chance(0.7)) parts.push_back(makeChimney(style, walls, tiles, random));
  if (style.shop) parts.push_back(makeShopSign(style, tiles, random));
  return Body(std::move(parts));
}

}  // namespace rotrocc
