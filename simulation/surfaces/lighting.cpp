#include "simulation/surfaces/lighting.h"

#include <algorithm>
#include <cmath>

#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

/// Share of a lamp's greatest intensity: fades to the sides, and downwards from the cut-off.
double beam(const HeadLamps& lamps, const Eigen::Vector3d& direction) {
  constexpr double kStray = 0.02;  // above the cut-off
  constexpr double kEdge_rad = 0.012;
  constexpr double kDeep_rad = 0.2;
  if (direction.z() <= 0.0) return 0.0;
  const double aside = std::atan2(direction.x(), direction.z()) / lamps.half_width_rad;
  const double below = direction.y() / direction.z() - lamps.cut_off_rad;
  const double deep = std::max(below, 0.0) / kDeep_rad;
  const double full = mix(kStray, 1.0, smoothStep(-kEdge_rad, kEdge_rad, below));
  return full * std::exp(-aside * aside) / (1.0 + deep * deep);
}

}  // namespace

Lighting nightLighting() {
  Lighting night;
  night.sun = 0.0;
  night.ambient = 0.012;
  night.sky = 0.02;
  night.street_lamps = 0.5;
  night.lights = 1.0;
  night.head_lamps.brightness = 4.0;
  return night;
}

const Eigen::Vector3d& directionToSun() {
  static const Eigen::Vector3d kDirection = Eigen::Vector3d(-0.45, -0.95, -0.62).normalized();
  return kDirection;
}

double daylight(const Lighting& lighting, const Eigen::Vector3d& normal, double sunlit) {
  const double sky = lighting.ambient * (0.8 - 0.2 * normal.y());  // y points down
  return sky + lighting.sun * sunlit * std::max(0.0, normal.dot(directionToSun()));
}

double headLight(const HeadLamps& lamps,
                 const Eigen::Vector3d& position,
                 const Eigen::Vector3d& normal) {
  constexpr double kDistance_m = 10.0;  // of the given brightness
  double light = 0.0;
  for (const double side : {-0.5, 0.5}) {
    const Eigen::Vector3d lamp = lamps.middle_m + Eigen::Vector3d(side * lamps.apart_m, 0.0, 0.0);
    const Eigen::Vector3d way = position - lamp;
    const double distance = std::max(way.norm(), 1.0);
    const double facing = std::max(0.0, -normal.dot(way) / distance);
    const double near = kDistance_m / distance;
    light += 0.5 * lamps.brightness * near * near * facing * beam(lamps, way);
  }
  return light;
}

double streetLight(const std::vector<Eigen::Vector3d>& lamps,
                   const Eigen::Vector3d& position,
                   const Eigen::Vector3d& normal) {
  constexpr double kReach_m = 35.0;
  constexpr double kHeight_m = 6.5;
  double light = 0.0;
  for (const Eigen::Vector3d& lamp : lamps) {
    const Eigen::Vector3d way = position - lamp;
    if (way.squaredNorm() > kReach_m * kReach_m) continue;
    const double distance = std::max(way.norm(), 0.5);
    const double facing = -normal.dot(way) / distance;
    const double down = way.y() / distance;  // cosine to the vertical: a lamp shines downwards
    if (facing <= 0.0 || down <= 0.0) continue;
    const double near = kHeight_m / distance;
    light += near * near * facing * std::sqrt(down) *
             (1.0 - smoothStep(0.5 * kReach_m, kReach_m, distance));
  }
  return light;
}

}  // namespace rotrocc
