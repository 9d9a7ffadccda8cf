#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "simulation/scene/body.h"
#include "simulation/scene/scene_geometry.h"
#include "simulation/scene/view.h"
#include "simulation/street/path.h"
#include "simulation/street/road_surface.h"
#include "simulation/street/street_map.h"
#include "simulation/street/street_style.h"
#include "simulation/surfaces/lighting.h"
#include "simulation/surfaces/shadows.h"
#include "simulation/surfaces/texture_tiles.h"
#include "simulation/surfaces/weather.h"

namespace rotrocc {

/// Description of the simulated world.
struct WorldPlan {
  std::vector<Path> streets;  ///< centre lines, at the height of the camera
  std::vector<Path> drives;   ///< paths of cars, kept free; the first is the camera's
  double beyond_m = 0.0;      ///< extension before their starts and after their ends
  StreetStyle style;
  std::vector<Crossing> crossings;
  Weather weather;
  Lighting lighting;
  bool indoors = false;  ///< the ground is level at y = 0, and the sky is not reflected
  /// Bodies that stand there besides those of the streets.
  std::function<std::vector<Body>(const TextureTiles&)> furniture;
  double tiled_share = 0.0;  ///< share of all textures that is the same tile everywhere
  std::uint64_t seed = 1;

  /// The drives with their extensions.
  std::vector<Path> wholeDrives() const;
};

/// Appearance in a direction.
struct Sighting {
  double brightness;      ///< 1 is white
  double depth;           ///< along the ray, in units of its length; infinite for the sky
  std::uint32_t surface;  ///< equal for pixels without an edge between them
  int moving_body;        ///< index of the visible body in View::moving(); -1: none
};

/// A street or another place, with its surroundings and the sky.
class World {
 public:
  explicit World(const WorldPlan& plan);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const Terrain& terrain() const { return scene_.terrain(); }
  const std::vector<Body>& bodies() const { return scene_.bodies(); }
  const TextureTiles& tiles() const { return tiles_; }

  /// Moves leaves and grass to where they are at this time.
  void setTime(double time_s) { tiles_.wind.time_s = time_s; }

  /// Moves the head lamps to where the own car is, by the pose of its left camera.
  void setCar(const Eigen::Isometry3d& T_world_camera) { T_car_world_ = T_world_camera.inverse(); }

  /// Casts a ray through a (sub-)pixel of a view, whose static bodies are bodies().
  Sighting look(const View& view, double x, double y) const;

  /// Visible share of the sun at a place on the ground, from 0 to 1.
  double lit(double x, double z) const { return shadows_.lit(x, z); }

 private:
  double bodyBrightness(const Body& body,
                        const BodyHit& hit,
                        const Ray& ray,
                        const PixelSpread& spread) const;
  double withTiles(double reflectance, const SurfacePoint& point) const;
  double reflection(const Eigen::Vector3d& direction,
                    const Eigen::Vector3d& normal,
                    const PixelSpread& spread) const;
  double illumination(const Eigen::Vector3d& position,
                      const Eigen::Vector3d& normal,
                      double lit) const;
  double groundBrightness(const SurfacePoint& point, const std::vector<Body>& moving) const;

  StreetStyle style_;
  Weather weather_;
  Lighting lighting_;
  double tiled_share_;
  Eigen::Isometry3d T_car_world_ = Eigen::Isometry3d::Identity();
  TextureTiles tiles_;
  StreetMap streets_;
  RoadSurface road_;
  SceneGeometry scene_;
  GroundShadows shadows_;
  std::vector<Eigen::Vector3d> lamps_;  // where the street lamps are
};

}  // namespace rotrocc
