#include "simulation/street/road_surface.h"

#include <algorithm>
#include <cmath>

#include "simulation/counter_random.h"
#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

constexpr double kPaint = 0.72;
constexpr double kRepairSlot_m = 12.0;
constexpr double kManholeSlot_m = 17.0;

struct Slot {
  std::uint64_t key;
  double start_m;
};

Slot slotOf(const StreetPoint& point, double length_m, std::uint64_t seed) {
  const double number = std::floor(point.station_m / length_m);
  const auto bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(number));
  return {randomBits(seed, bits, point.street), length_m * number};
}

}  // namespace

double RoadSurface::reflectance(const SurfacePoint& point) const {
  const TexturePoint at = project(point, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ());
  Place place;
  if (!streets_.locate(at.at.x(), at.at.y(), place.street)) return pavement(Pavement::kGrass, at);

  const auto spread = [&](const Eigen::Vector2d& gradient) {
    const Eigen::Vector2d change(gradient.dot(at.per_column), gradient.dot(at.per_row));
    return std::clamp(1.2 * change.norm(), 1e-4, 3.0);
  };
  place.length = spread(place.street.station_gradient);
  place.width = spread(place.street.right_gradient);

  double brightness = 0.0;
  double rest = 1.0;
  for (const Zone& zone : style_.zones) {
    const double share =
        coverageBetween(zone.left_m, zone.right_m, place.street.right_m, place.width);
    if (share <= 0.0) continue;
    double surface = pavement(zone.pavement, at);
    if (zone.pavement == Pavement::kAsphalt) {
      surface = withManholes(place, withRepairs(place, surface));
    }
    brightness += share * surface;
    rest -= share;
  }
  if (rest > 1e-3) brightness += rest * pavement(Pavement::kGrass, at);
  const double paint = paintCoverage(place);
  if (paint <= 0.0) return brightness;
  const double worn = 0.7 + 0.3 * smoothStep(0.35, 0.5, tiles_.asphalt.at(at));
  return mix(brightness, kPaint, worn * paint);
}

double RoadSurface::pavement(Pavement kind, const TexturePoint& at) const {
  switch (kind) {
    case Pavement::kAsphalt:
      return 0.31 * (1.0 + 2.0 * style_.asphalt_contrast * (tiles_.asphalt.at(at) - 0.47));
    case Pavement::kSlabs:
      return 0.42 * (1.0 + 0.9 * (tiles_.paving.at(at) - 0.5));
    case Pavement::kGrass: {
      const double stain = tiles_.blotches.at(scaled(at, 1.0 / 41.0)) - 0.5;
      return 0.26 * (1.0 + 1.3 * (tiles_.grass.at(at) - 0.5) + 0.9 * stain);
    }
  }
  return 0.0;
}

double RoadSurface::withRepairs(const Place& place, double brightness) const {
  const auto [key, slot_m] = slotOf(place.street, kRepairSlot_m, seed_);
  if (randomUniform(key, 0) > style_.repairs_share) return brightness;
  const double first = slot_m + 0.6 + 4.0 * randomUniform(key, 1);
  const double last = first + 1.0 + 6.0 * randomUniform(key, 2);
  const double left = -5.0 + 8.0 * randomUniform(key, 3);
  const double right = left + 0.8 + 2.0 * randomUniform(key, 4);
  const auto area = [&](double margin) {
    return coverageBetween(first - margin, last + margin, place.street.station_m, place.length) *
           coverageBetween(left - margin, right + margin, place.street.right_m, place.width);
  };
  const double tone = 0.62 + 0.6 * randomUniform(key, 5);
  return mix(mix(brightness, 0.1, area(0.05)), tone * brightness, area(0.0));
}

double RoadSurface::withManholes(const Place& place, double brightness) const {
  const auto [key, slot_m] = slotOf(place.street, kManholeSlot_m, seed_ + 1);
  if (randomUniform(key, 0) > 2.0 * style_.repairs_share) return brightness;
  const double along = place.street.station_m - slot_m - 1.0 - 15.0 * randomUniform(key, 1);
  const double across = place.street.right_m + 3.0 - 6.0 * randomUniform(key, 2);
  const double radius = std::hypot(along, across);
  const double pixel = std::max(place.length, place.width);
  const double lid = 1.0 - coverageAbove(0.36, radius, pixel);
  if (lid <= 0.0) return brightness;
  const double rim = 1.0 - coverageAbove(0.31, radius, pixel);
  const double studs = coveragePeriodic(0.1, 0.05, along, place.length) *
                       coveragePeriodic(0.1, 0.05, across, place.width);
  return mix(mix(brightness, 0.4, lid), 0.12 + 0.3 * studs, rim);
}

double RoadSurface::paintCoverage(const Place& place) const {
  const double s = place.street.station_m;
  const double right = place.street.right_m;
  double coverage = crossingCoverage(place);
  for (const Marking& line : style_.markings) {
    const double half = 0.5 * line.width_m;
    const double across =
        coverageBetween(line.right_m - half, line.right_m + half, right, place.width);
    if (across <= 0.0) continue;
    const bool dashed = line.dash_m < line.period_m;
    coverage +=
        across * (dashed ? coveragePeriodic(line.period_m, line.dash_m, s, place.length) : 1.0);
  }
  for (const Bay& bay : style_.bays) {
    coverage += coverageBetween(bay.left_m, bay.right_m, right, place.width) *
                coveragePeriodic(bay.period_m, 0.1, s, place.length);
  }
  return std::min(coverage, 1.0);
}

double RoadSurface::crossingCoverage(const Place& place) const {
  double coverage = 0.0;
  for (const Crossing& crossing : crossings_) {
    if (crossing.street != place.street.street) continue;
    const double length = crossing.zebra ? 3.0 : 0.5;
    const double along = coverageBetween(
        crossing.station_m, crossing.station_m + length, place.street.station_m, place.length);
    if (along <= 0.0) continue;
    coverage +=
        along * (crossing.zebra ? coverageBetween(-5.5, 5.5, place.street.right_m, place.width) *
                                      coveragePeriodic(1.0, 0.5, place.street.right_m, place.width)
                                : coverageBetween(0.1, 3.4, place.street.right_m, place.width));
  }
  return coverage;
}

}  // namespace rotrocc
