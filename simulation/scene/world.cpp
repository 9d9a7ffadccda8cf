#include "simulation/scene/world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "simulation/street/street_layout.h"
#include "simulation/surfaces/coverage.h"
#include "simulation/surfaces/sky.h"

namespace rotrocc {
namespace {

constexpr double kStreetReach_m = 20.5;
constexpr double kNearestSurface_m = 0.2;

constexpr std::uint32_t kSkySurface = 0xFFFFFFFF;
constexpr std::uint32_t kGroundSurface = 0xFFFFFFFE;
constexpr std::uint32_t kTangleSurface = 0xFFFFFFFD;

SceneGeometry makeScene(const WorldPlan& plan,
                        const StreetMap& streets,
                        const TextureTiles& tiles) {
  Terrain terrain = groundBelow(plan.drive, plan.beyond_m, plan.streets);
  std::vector<Body> bodies = layOutStreets(plan, streets, terrain, tiles);
  SceneGeometry scene(std::move(terrain), std::move(bodies));
  for (Body& body : scene.bodies()) {
    if (body.own_shade) body.lit = sunlitTop(scene, body);
  }
  return scene;
}

/// Ambient occlusion beside and below a body on the ground: 1 is full light.
double contactShade(const Body& body, const Eigen::Vector3d& position) {
  const Eigen::Vector3d own = body.toBody(position);
  const Eigen::AlignedBox3d& box = body.ownBounds();
  const double x = std::max(box.min().x() - own.x(), own.x() - box.max().x());
  const double z = std::max(box.min().z() - own.z(), own.z() - box.max().z());
  return mix(0.3, 1.0, smoothStep(-0.35, 0.45, std::max(x, z)));
}

}  // namespace

World::World(const WorldPlan& plan)
    : tiles_(plan.seed),
      streets_(plan.streets, kStreetReach_m),
      road_(streets_, plan.style, tiles_, plan.crossings, plan.seed),
      scene_(makeScene(plan, streets_, tiles_)),
      shadows_(scene_, streets_) {}

Sighting World::look(const View& view, double x, double y) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Ray ray = view.ray(x, y);
  RayRange range = {kNearestSurface_m, kInfinity};
  BodyHit hit;
  int number = -1;
  if (view.intersect(x, y, range, hit, number)) range.to = hit.distance;
  double depth = 0.0;
  if (scene_.traceGround(ray, range, depth)) {
    const Eigen::Vector3d at = ray.at(depth);
    const Eigen::Vector3d normal = scene_.terrain().normal(at.x(), at.z());
    const SurfacePoint point = surfacePoint(ray, view.spread(), depth, normal);
    return {groundBrightness(point, view.moving()), depth, kGroundSurface};
  }
  if (number < 0) {
    return {skyBrightness(tiles_, ray.direction, view.spread()), kInfinity, kSkySurface};
  }
  const Body& body = view.body(number);
  const Part& part = body.parts()[static_cast<std::size_t>(hit.part)];
  const auto face = static_cast<std::uint32_t>((number * 32 + hit.part) * 64 + hit.face);
  const std::uint32_t surface = part.material.is_tangle ? kTangleSurface : face;
  const SurfacePoint point =
      surfacePoint(body.toBody(ray), body.toBody(view.spread()), hit.distance, hit.normal);
  const Eigen::Vector3d normal = body.T_world_body().linear() * hit.normal;
  return {part.material.reflectance(point) * daylight(normal, body.lit), hit.distance, surface};
}

double World::groundBrightness(const SurfacePoint& point, const std::vector<Body>& moving) const {
  const Eigen::Vector3d& at = point.position;
  double shade = 1.0;
  for (const std::int32_t index : scene_.bodiesAround(at.x(), at.z())) {
    const Body& body = bodies()[index];
    if (body.contact_shadow) shade *= contactShade(body, at);
  }
  for (const Body& body : moving) {
    const double reach = body.ownBounds().diagonal().norm();
    if ((body.T_world_body().translation() - at).squaredNorm() > reach * reach) continue;
    shade *= contactShade(body, at);
  }
  const double lit = shadows_.lit(at.x(), at.z());
  return road_.reflectance(point) * shade * daylight(point.normal, lit);
}

}  // namespace rotrocc
