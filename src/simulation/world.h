#pragma once

#include <cstdint>
#include <vector>

#include "simulation/body.h"
#include "simulation/ground_history.h"
#include "simulation/path.h"
#include "simulation/road_surface.h"
#include "simulation/scene_geometry.h"
#include "simulation/sky.h"
#include "simulation/street_map.h"
#include "simulation/street_style.h"
#include "simulation/sunlight.h"
#include "simulation/texture_tiles.h"
#include "simulation/view.h"

namespace rotrocc {

/// What the simulated world is made of.
struct WorldPlan {
  std::vector<Path> streets;  ///< centre lines, at the height of the camera
  std::vector<Path> drives;   ///< where cars drive: nothing stands there. First: the camera
  double beyond_m = 0.0;      ///< they go on before their starts and after their ends
  StreetStyle style;
  std::vector<Crossing> crossings;
  double camera_height_m = 1.65;
  std::uint64_t seed = 1;

  /// The drives with how they go on.
  std::vector<Path> wholeDrives() const;
};

/// What is seen in a direction.
struct Sighting {
  double brightness;      ///< 1 is white
  double depth;           ///< along the ray, in units of its length; infinite for the sky
  std::uint32_t surface;  ///< alike where no edge lies between two pixels
  int moving_body;        ///< index in View::moving() of the moving body that is seen; -1: none
};

/// A street with all that stands beside it, under the sky.
class World {
 public:
  explicit World(const WorldPlan& plan);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const Terrain& terrain() const { return scene_.terrain(); }
  const std::vector<Body>& bodies() const { return scene_.bodies(); }
  const StreetMap& streets() const { return streets_; }

  /// Makes the ground, with all that stands on it, what it is while the camera is at a station of
  /// its path. It may differ from before where the path comes back to a place at another height.
  void goTo(double station_m);

  /// Looks through a pixel of a view, whose standing bodies are bodies(). Pixels may be fractions.
  Sighting look(const View& view, double x, double y) const;

  /// How much of the sun reaches a place on the ground, from 0 to 1.
  double sunlit(double x, double z) const { return shadows_.sunlit(x, z); }

 private:
  double bodyBrightness(const Body& body,
                        const BodyHit& hit,
                        const Ray& ray,
                        const PixelSpread& spread) const;
  double groundBrightness(const SurfacePoint& point, const std::vector<Body>& moving) const;

  StreetStyle style_;
  TextureTiles tiles_;
  StreetMap streets_;
  RoadSurface road_;
  GroundGrid grid_;
  GroundHistory ground_;
  SceneGeometry start_;  // the scene at the start of the drive
  SceneGeometry scene_;  // as it is now
  std::size_t stage_ = 0;
  SunShadows shadows_;
  Sky sky_;
};

}  // namespace rotrocc
