#pragma once

#include <cstdint>
#include <vector>

#include "simulation/scene/body.h"
#include "simulation/scene/scene_geometry.h"
#include "simulation/scene/view.h"
#include "simulation/street/path.h"
#include "simulation/street/road_surface.h"
#include "simulation/street/street_map.h"
#include "simulation/street/street_style.h"
#include "simulation/surfaces/shadows.h"
#include "simulation/surfaces/texture_tiles.h"

namespace rotrocc {

struct WorldPlan {
  std::vector<Path> streets;  ///< center lines, at the height of the camera
  Path drive;                 ///< the path of the camera, kept free
  double beyond_m;            ///< extension before its start and after its end
  StreetStyle style;
  std::vector<Crossing> crossings;
  std::uint64_t seed;
};

struct Sighting {
  double brightness;      ///< 1 is white
  double depth;           ///< along the ray, in units of its length; infinite for the sky
  std::uint32_t surface;  ///< equal for pixels without an edge between them
};

/// Streets with their surroundings and the sky.
class World {
 public:
  explicit World(const WorldPlan& plan);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const Terrain& terrain() const { return scene_.terrain(); }
  const std::vector<Body>& bodies() const { return scene_.bodies(); }

  /// Casts a ray through a (sub-)pixel of a view, whose static bodies are bodies().
  Sighting look(const View& view, double x, double y) const;

  /// Visible share of the sun at a place on the ground, from 0 to 1.
  double lit(double x, double z) const { return shadows_.lit(x, z); }

 private:
  double groundBrightness(const SurfacePoint& point, const std::vector<Body>& moving) const;

  TextureTiles tiles_;
  StreetMap streets_;
  RoadSurface road_;
  SceneGeometry scene_;
  GroundShadows shadows_;
};

}  // namespace rotrocc
