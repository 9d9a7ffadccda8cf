#include "simulation/scene/world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "simulation/scene/ground.h"
#include "simulation/street/street_layout.h"
#include "simulation/surfaces/coverage.h"
#include "simulation/surfaces/sky.h"

namespace rotrocc {
namespace {

constexpr double kCameraHeight_m = 1.65;
constexpr double kGroundCell_m = 8.0;  // the ground bends at their borders
constexpr double kGridMargin_m = 200.0;
constexpr double kStreetReach_m = 20.5;
constexpr double kShadowReach_m = 14.0;
constexpr double kNearestSurface_m = 0.2;

constexpr std::uint32_t kSkySurface = 0xFFFFFFFF;
constexpr std::uint32_t kGroundSurface = 0xFFFFFFFE;
constexpr std::uint32_t kTangleSurface = 0xFFFFFFFD;

std::vector<Path> joined(std::vector<Path> a, const std::vector<Path>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Terrain groundOf(const WorldPlan& plan) {
  const GroundGrid grid =
      GroundGrid::around(joined(plan.wholeDrives(), plan.streets), kGridMargin_m, kGroundCell_m);
  if (plan.indoors) {
    return {grid,
            std::vector<double>(static_cast<std::size_t>(grid.columns + 1) * (grid.rows + 1))};
  }
  return {grid,
          groundBelow(grid, plan.drives.front(), plan.beyond_m, plan.streets, kCameraHeight_m)};
}

SceneGeometry makeScene(const WorldPlan& plan,
                        const StreetMap& streets,
                        const TextureTiles& tiles) {
  Terrain terrain = groundOf(plan);
  std::vector<Body> bodies = layOutStreets(plan, streets, terrain, tiles);
  if (plan.furniture) {
    for (Body& body : plan.furniture(tiles)) bodies.push_back(std::move(body));
  }
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

/// Share of light that glass reflects (Schlick 1994).
double mirroredShare(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal) {
  constexpr double kStraightOn = 0.08;  // of both sides of a pane
  const double flat = 1.0 - std::abs(normal.dot(direction)) / direction.norm();
  return kStraightOn + (1.0 - kStraightOn) * flat * flat * flat * flat * flat;
}

/// Reflectance of a surface of square tiles, of which one looks as the other.
double tiledReflectance(const TexturePoint& point) {
  constexpr double kTile_m = 0.4;
  double light = 0.0;
  for (const int axis : {0, 1}) {
    light +=
        coveragePeriodic(kTile_m, 0.5 * kTile_m, point.at[axis], std::max(point.width(axis), 1e-4));
  }
  return 0.15 + 0.3 * light;
}

}  // namespace

std::vector<Path> WorldPlan::wholeDrives() const {
  std::vector<Path> whole;
  for (const Path& drive : drives) whole.push_back(drive.beside(0.0, beyond_m));
  return whole;
}

World::World(const WorldPlan& plan)
    : style_(plan.style),
      weather_(plan.weather),
      lighting_(plan.lighting),
      tiled_share_(plan.tiled_share),
      tiles_(plan.seed),
      streets_(plan.streets, kStreetReach_m),
      road_(streets_, style_, tiles_, plan.crossings, plan.seed),
      scene_(makeScene(plan, streets_, tiles_)),
      shadows_(scene_, [&](double x, double z) {
        return plan.lighting.sun > 0.0 && streets_.distance(x, z) < kShadowReach_m;
      }) {
  weather_.reflections = plan.weather.reflections && !plan.indoors;
  tiles_.wind = plan.weather.wind;
  for (const Body& body : bodies()) {
    if (body.lamp) lamps_.push_back(body.T_world_body() * *body.lamp);
  }
}

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
    return {groundBrightness(point, view.moving()), depth, kGroundSurface, -1};
  }
  if (number < 0) {
    const double sky = lighting_.sky * skyBrightness(tiles_, ray.direction, view.spread());
    return {sky, kInfinity, kSkySurface, -1};
  }
  const Body& body = view.body(number);
  const Part& part = body.parts()[static_cast<std::size_t>(hit.part)];
  const auto face = static_cast<std::uint32_t>((number * 32 + hit.part) * 64 + hit.face);
  const std::uint32_t surface = part.material->isTangle() ? kTangleSurface : face;
  return {bodyBrightness(body, hit, ray, view.spread()),
          hit.distance,
          surface,
          number < view.standingCount() ? -1 : number - view.standingCount()};
}

double World::bodyBrightness(const Body& body,
                             const BodyHit& hit,
                             const Ray& ray,
                             const PixelSpread& spread) const {
  const SurfacePoint point =
      surfacePoint(body.toBody(ray), body.toBody(spread), hit.distance, hit.normal);
  const Eigen::Vector3d normal = body.T_world_body().linear() * hit.normal;
  const Eigen::Vector3d at = ray.at(hit.distance);
  const Material& material = *body.parts()[static_cast<std::size_t>(hit.part)].material;
  const double light = illumination(at, normal, body.lit);
  double brightness = withTiles(material.reflectance(point), point) * light;
  if (lighting_.lights > 0.0) brightness += lighting_.lights * material.glow(point);
  if (!weather_.reflections) return brightness;
  const double gloss = material.gloss(point);
  if (gloss <= 0.0) return brightness;
  const double mirrored = gloss * mirroredShare(ray.direction, normal);
  return mix(brightness, reflection(ray.direction, normal, spread), mirrored);
}

double World::withTiles(double reflectance, const SurfacePoint& point) const {
  if (tiled_share_ <= 0.0) return reflectance;
  return mix(reflectance, tiledReflectance(faceCoordinates(point)), tiled_share_);
}

double World::reflection(const Eigen::Vector3d& direction,
                         const Eigen::Vector3d& normal,
                         const PixelSpread& spread) const {
  constexpr double kGlint = 0.01;  // squared angle [rad^2] where the sun fades
  const Eigen::Vector3d towards = direction - 2.0 * normal.dot(direction) * normal;
  const double away = 2.0 - 2.0 * towards.normalized().dot(directionToSun());
  return lighting_.sky * skyBrightness(tiles_, towards, spread) +
         10.0 * lighting_.sun * (1.0 - smoothStep(0.0, kGlint, away));
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
  return withTiles(road_.reflectance(point), point) * shade * illumination(at, point.normal, lit);
}

double World::illumination(const Eigen::Vector3d& position,
                           const Eigen::Vector3d& normal,
                           double lit) const {
  double light = daylight(lighting_, normal, lit);
  if (lighting_.street_lamps > 0.0) {
    light += lighting_.street_lamps * streetLight(lamps_, position, normal);
  }
  if (lighting_.head_lamps > 0.0) {
    light +=
        lighting_.head_lamps * headLight(T_car_world_ * position, T_car_world_.linear() * normal);
  }
  return light;
}

}  // namespace rotrocc
