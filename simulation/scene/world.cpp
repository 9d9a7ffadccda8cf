#include "simulation/scene/world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "simulation/counter_random.h"
#include "simulation/street/street_layout.h"
#include "simulation/stress/repeated_texture.h"
#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

constexpr double kGridMargin_m = 200.0;
constexpr double kStreetReach_m = 20.5;
constexpr double kShadowReach_m = 14.0;
constexpr double kNearestSurface_m = 0.2;
constexpr double kSkyDistance_m = 300.0;  // of what mist hides: hills and clouds

constexpr std::uint32_t kSkySurface = 0xFFFFFFFF;
constexpr std::uint32_t kGroundSurface = 0xFFFFFFFE;
constexpr std::uint32_t kTangleSurface = 0xFFFFFFFD;

std::vector<Path> joined(std::vector<Path> a, const std::vector<Path>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

GroundGrid gridOf(const WorldPlan& plan) {
  if (plan.ground) return GroundGrid::over(plan.ground->area, plan.ground->cell_m);
  return GroundGrid::around(joined(plan.wholeDrives(), plan.streets), kGridMargin_m, plan.cell_m);
}

GroundHistory groundOf(const WorldPlan& plan, const GroundGrid& grid) {
  if (plan.ground) return {grid, plan.ground->height};
  return {grid, plan.drives.front(), plan.beyond_m, plan.streets, plan.camera_height_m};
}

/// Whether shadows are cast on the ground there.
bool hasShadows(const WorldPlan& plan, const StreetMap& streets, double x, double z) {
  if (!plan.light && plan.lighting.sun <= 0.0) return false;
  return plan.streets.empty() || streets.distance(x, z) < kShadowReach_m;
}

SceneGeometry makeScene(const WorldPlan& plan,
                        const Light& light,
                        const StreetMap& streets,
                        Terrain terrain,
                        const TextureTiles& tiles) {
  std::vector<Body> bodies = layOutStreets(plan, streets, terrain, tiles);
  if (plan.furniture) {
    for (Body& body : plan.furniture(tiles)) bodies.push_back(std::move(body));
  }
  SceneGeometry scene(terrain, bodies);
  for (Body& body : bodies) {
    if (body.own_shade) body.lit = litTop(scene, light, body);
  }
  return {std::move(terrain), std::move(bodies)};
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

}  // namespace

std::vector<Path> WorldPlan::wholeDrives() const {
  constexpr double kSpacing_m = 0.5;
  std::vector<Path> whole;
  for (const Path& drive : drives)
    whole.push_back(drive.beside(0.0, kSpacing_m, beyond_m, beyond_m));
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
      floor_(plan.floor ? plan.floor(tiles_) : nullptr),
      light_(plan.light ? plan.light : std::make_shared<Daylight>(plan.lighting)),
      grid_(gridOf(plan)),
      ground_(groundOf(plan, grid_)),
      rough_m_(plan.rough_m),
      seed_(plan.seed),
      start_(makeScene(plan, *light_, streets_, terrainAt(0), tiles_)),
      scene_(start_),
      shadows_(scene_,
               *light_,
               plan.shadow_cell_m,
               [&](double x, double z) { return hasShadows(plan, streets_, x, z); }),
      lamps_(scene_),
      sky_(tiles_) {
  weather_.reflections = plan.weather.reflections && plan.under_sky;
  tiles_.wind = plan.weather.wind;
}

Terrain World::terrainAt(std::size_t stage) const {
  std::vector<double> heights = ground_.heights(stage);
  if (rough_m_ > 0.0) {
    for (std::size_t corner = 0; corner < heights.size(); ++corner) {
      heights[corner] += rough_m_ * (2.0 * randomUniform(seed_, 0x4061, corner) - 1.0);
    }
  }
  return {grid_, heights};
}

void World::goTo(double station_m) {
  const std::size_t stage = ground_.stage(station_m);
  if (stage == stage_) return;
  stage_ = stage;
  Terrain terrain = terrainAt(stage);
  std::vector<Body> bodies = start_.bodies();
  for (Body& body : bodies) {
    Eigen::Isometry3d pose = body.T_world_body();
    const Eigen::Vector3d at = pose.translation();
    pose.translation().y() +=
        terrain.height(at.x(), at.z()) - start_.terrain().height(at.x(), at.z());
    body.place(pose);
  }
  scene_ = SceneGeometry(std::move(terrain), std::move(bodies));
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
    double brightness = groundBrightness(point, view.moving());
    if (weather_.wet > 0.0)
      brightness = wetBrightness(point, brightness, ray, depth, view.spread());
    return {inMist(brightness, ray, depth), depth, kGroundSurface, -1};
  }
  if (number < 0) {
    const double sky = lighting_.sky * sky_.brightness(ray.direction, view.spread());
    return {inMist(sky, ray, kSkyDistance_m), kInfinity, kSkySurface, -1};
  }
  const Body& body = view.body(number);
  const Part& part = body.parts()[static_cast<std::size_t>(hit.part)];
  const auto face = static_cast<std::uint32_t>((number * 32 + hit.part) * 64 + hit.face);
  const std::uint32_t surface = part.material->isTangle() ? kTangleSurface : face;
  return {inMist(bodyBrightness(body, hit, ray, view.spread()), ray, hit.distance),
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
  const double lit = body.is_ground ? shadows_.lit(at.x(), at.z()) : body.lit;
  const Material& material = *body.parts()[static_cast<std::size_t>(hit.part)].material;
  const double light = illumination(at, normal, lit);
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
  return lighting_.sky * sky_.brightness(towards, spread) +
         10.0 * lighting_.sun * (1.0 - smoothStep(0.0, kGlint, away));
}

double World::wetBrightness(const SurfacePoint& point,
                            double dry,
                            const Ray& ray,
                            double depth,
                            const PixelSpread& spread) const {
  constexpr double kDarker = 0.45;      // of wet asphalt
  constexpr double kStraightOn = 0.02;  // reflected by water (Schlick 1994)
  constexpr double kAbove_m = 0.01;     // the start of a ray
  constexpr double kRough = 8.0;        // width of a mirrored pixel, in pixels
  const double water = weather_.wet * road_.water(point);
  if (water <= 0.0) return dry;
  const Eigen::Vector3d towards =
      ray.direction - 2.0 * point.normal.dot(ray.direction) * point.normal;
  const double flat = 1.0 - std::abs(point.normal.dot(ray.direction)) / ray.direction.norm();
  const double share = mix(kStraightOn, 1.0, flat * flat * flat * flat * flat);
  const Ray mirrored = {point.position + kAbove_m * point.normal, towards};
  SceneHit hit;
  double seen = dry;
  if (!scene_.trace(mirrored,
                    {0.0, std::numeric_limits<double>::infinity()},
                    kRough * spread.per_row.norm(),
                    hit)) {
    seen = lighting_.sky * sky_.brightness(towards, spread);
  } else if (hit.body >= 0) {
    const double wider = kRough * (1.0 + depth / hit.at.distance);
    const PixelSpread there = {wider * spread.per_column, wider * spread.per_row};
    seen = bodyBrightness(bodies()[hit.body], hit.at, mirrored, there);
  }
  return mix((1.0 - kDarker * water) * dry, seen, water * share);
}

double World::inMist(double brightness, const Ray& ray, double depth) const {
  constexpr double kContrastLeft = 0.05;
  if (std::isinf(weather_.visibility_m)) return brightness;
  const double share = depth * ray.direction.norm() / weather_.visibility_m;
  return mix(lighting_.sky, brightness, std::pow(kContrastLeft, share));
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
  const double reflectance = floor_ ? floor_->reflectance(point) : road_.reflectance(point);
  return withTiles(reflectance, point) * shade * illumination(at, point.normal, lit);
}

double World::illumination(const Eigen::Vector3d& position,
                           const Eigen::Vector3d& normal,
                           double lit) const {
  double light = light_->illumination(position, normal, lit);
  if (lighting_.street_lamps > 0.0) {
    light += lighting_.street_lamps * lamps_.light(position, normal);
  }
  if (lighting_.head_lamps.brightness > 0.0) {
    light +=
        headLight(lighting_.head_lamps, T_car_world_ * position, T_car_world_.linear() * normal);
  }
  return light;
}

}  // namespace rotrocc
