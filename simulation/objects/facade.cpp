#include "simulation/objects/facade.h"

#include <algorithm>
#include <cmath>

#include "simulation/counter_random.h"
#include "simulation/surfaces/coverage.h"

namespace rotrocc {

Facade::Facade(const FacadeStyle& style, const TextureTiles& tiles)
    : style_(style),
      tiles_(tiles),
      front_half_row_(halfRow(style.half_width)),
      side_half_row_(halfRow(style.half_depth)) {}

double Facade::halfRow(double half_wall) const {
  const double columns = std::max(1.0, std::floor((2.0 * half_wall - 0.6) / style_.window_spacing));
  return 0.5 * columns * style_.window_spacing;
}

double Facade::reflectance(const SurfacePoint& point) const {
  const Place place = placeOf(point);
  double brightness = wall(place);
  brightness = withLedges(place, brightness);
  brightness = withWindows(place, brightness);
  return withGroundFloor(place, brightness);
}

double Facade::gloss(const SurfacePoint& point) const {
  return windowCoverage(placeOf(point), 0.0);
}

double Facade::glow(const SurfacePoint& point) const {
  constexpr double kLitShare = 0.3;
  const Place place = placeOf(point);
  if (place.row < 1.0 && (style_.shop || place.column == style_.door)) return 0.0;
  const double glass = glassCoverage(place);
  if (glass <= 0.0) return 0.0;
  const double window = luck(place);  // those with half a curtain
  const double room = mix(0.25, 0.7, tiles_.blotches.at(scaled(place.point, 0.5)));
  const double single = window > 0.55 && window < 0.55 + kLitShare ? room : 0.0;
  return glass * mix(0.45 * kLitShare, single, place.resolved);
}

Facade::Place Facade::placeOf(const SurfacePoint& point) const {
  Place place;
  place.point = faceCoordinates(point);
  place.width = std::max(1.2 * place.point.width(0), 1e-4);
  place.height = std::max(1.2 * place.point.width(1), 1e-4);
  const bool front = std::abs(point.normal.z()) > std::abs(point.normal.x());
  const double half_row = front ? front_half_row_ : side_half_row_;
  place.u = place.point.at.x() + half_row;
  place.v = place.point.at.y();
  place.windows = coverageBetween(0.0, 2.0 * half_row, place.u, place.width) *
                  coverageBetween(0.0, style_.floors * style_.floor_height, place.v, place.height);
  place.column = std::floor(place.u / style_.window_spacing);
  place.row = std::floor(place.v / style_.floor_height);
  place.resolved = 1.0 - smoothStep(0.3, 0.6, place.width / style_.window_spacing);
  return place;
}

double Facade::wall(const Place& place) const {
  const double grain = style_.bricks ? 0.9 * (tiles_.bricks.at(place.point) - 0.56)
                                     : 0.5 * (tiles_.plaster.at(place.point) - 0.5);
  const double damp = 0.8 + 0.2 * smoothStep(0.0, 1.5, place.v);
  return style_.wall * damp * (1.0 + grain);
}

double Facade::withLedges(const Place& place, double brightness) const {
  const double plinth = 1.0 - coverageAbove(0.55, place.v, place.height);
  brightness = mix(brightness, 0.55 * brightness, plinth);
  const double upper = coverageAbove(0.5 * style_.floor_height, place.v, place.height);
  const double ledge = upper * coveragePeriodic(style_.floor_height, 0.14, place.v, place.height);
  const double shade =
      upper * coveragePeriodic(style_.floor_height, 0.1, place.v + 0.1, place.height);
  return mix(mix(brightness, 0.5 * brightness, shade), 1.15 * brightness, ledge);
}

double Facade::windowCoverage(const Place& place, double margin_m) const {
  const double left = 0.5 * (style_.window_spacing - style_.window_width) - margin_m;
  const double bottom = style_.sill_height - margin_m;
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

double Facade::glassCoverage(const Place& place) const {
  const double spacing = style_.window_spacing;
  const double bar = coveragePeriodic(spacing, 0.07, place.u - 0.5 * spacing + 0.035, place.width);
  const double crossbar =
      coveragePeriodic(style_.floor_height,
                       0.06,
                       place.v - style_.sill_height - 0.68 * style_.window_height,
                       place.height);
  return windowCoverage(place, 0.0) * (1.0 - bar) * (1.0 - crossbar);
}

double Facade::luck(const Place& place) const {
  const auto column = static_cast<std::uint64_t>(static_cast<std::int64_t>(place.column));
  const auto row = static_cast<std::uint64_t>(static_cast<std::int64_t>(place.row));
  return randomUniform(style_.key, column, row);
}

double Facade::pane(const Place& place) const {
  const double luck = this->luck(place);
  const double v = place.v - place.row * style_.floor_height - style_.sill_height;
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

double Facade::withWindows(const Place& place, double brightness) const {
  const double spacing = style_.window_spacing;
  if (style_.shutters > 0.0) {
    const double half = 0.5 * style_.window_width;
    const double shutter_left = 0.5 * spacing - 2.0 * half;
    const double beside =
        coveragePeriodic(spacing, 4.0 * half, place.u - shutter_left, place.width) *
        coveragePeriodic(
            style_.floor_height, style_.window_height, place.v - style_.sill_height, place.height);
    const double slats = 0.75 + 0.5 * coveragePeriodic(0.12, 0.06, place.v, place.height);
    brightness = mix(brightness, style_.shutters * slats, beside * place.windows);
  }
  const double frame = windowCoverage(place, 0.1);
  if (frame <= 0.0) return brightness;
  brightness = mix(brightness, style_.frame, frame);
  return mix(brightness, pane(place), glassCoverage(place));
}

double Facade::withGroundFloor(const Place& place, double brightness) const {
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
  const double centre = (style_.door + 0.5) * spacing;
  const auto area = [&](double half, double top) {
    return coverageBetween(centre - half, centre + half, place.u, place.width) *
           coverageBetween(0.0, top, place.v, place.height);
  };
  brightness = mix(brightness, style_.wall * 0.9, area(0.5 * spacing - 0.1, kDoor_m));
  brightness = mix(brightness, style_.frame, area(0.68, 2.45));
  brightness = mix(brightness, 0.16, area(0.55, 2.3));
  const double panels = coveragePeriodic(0.7, 0.5, place.v - 0.15, place.height);
  return mix(brightness, 0.24, panels * area(0.38, 2.1));
}

}  // namespace rotrocc
