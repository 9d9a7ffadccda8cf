#include "simulation/surfaces/lighting.h"

#include <algorithm>
#include <cmath>

#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

/// Share of a lamp's greatest intensity: fades to the sides, and downwards from the cut-off.
double beam(const Eigen::Vector3d& direction) {
  constexpr double kHalfWidth_rad = 0.45;  // where the light has fallen to 37 %
  constexpr double kCutOff_rad = 0.01;     // below the horizon; hardly any light above
  constexpr double kStray = 0.02;          // above the cut-off
  constexpr double kEdge_rad = 0.012;
  constexpr double kDeep_rad = 0.2;
  if (direction.z() <= 0.0) return 0.0;
  const double aside = std::atan2(direction.x(), direction.z()) / kHalfWidth_rad;
  const double below = direction.y() / direction.z() - kCutOff_rad;
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
  night.head_lamps = 4.0;
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

double headLight(const Eigen::Vector3d& position, const Eigen::Vector3d& normal) {
  constexpr double kDistance_m = 10.0;  // of the wall
  double light = 0.0;
  for (const double right_m : {-0.65, 0.65}) {
    const Eigen::Vector3d way = position - Eigen::Vector3d(right_m, 1.0, 1.5);
    const double distance = std::max(way.norm(), 1.0);
    const double facing = std::max(0.0, -normal.dot(way) / distance);
    const double near = kDistance_m / distance;
    light += 0.5 * near * near * facing * beam(way);
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
