#pragma once

#include <utility>
#include <vector>

#include "simulation/street/street_map.h"
#include "simulation/street/street_style.h"
#include "simulation/surfaces/surface_point.h"
#include "simulation/surfaces/texture_tiles.h"

namespace rotrocc {

/// A marking across a street: a stop line or a pedestrian crossing.
struct Crossing {
  int street;
  double station_m;
  bool zebra;  ///< stripes 3 m long from station_m on; else a stop line on the right half
};

/// Appearance of the ground: asphalt with markings and repairs, slabs, grass.
class RoadSurface {
 public:
  /// The streets and the textures must outlive this object.
  RoadSurface(const StreetMap& streets,
              StreetStyle style,
              const TextureTiles& tiles,
              std::vector<Crossing> crossings,
              std::uint64_t seed)
      : streets_(streets),
        style_(std::move(style)),
        tiles_(tiles),
        crossings_(std::move(crossings)),
        seed_(seed) {}

  /// Reflectance of the ground, averaged over the pixel. `point` is in the world's frame.
  double reflectance(const SurfacePoint& point) const;

 private:
  /// A pixel on the street: along and across it.
  struct Place {
    StreetPoint street;
    double length;  // of the pixel along the street [m]
    double width;   // across [m]
  };

  double pavement(Pavement kind, const TexturePoint& at) const;
  double withRepairs(const Place& place, double brightness) const;
  double withManholes(const Place& place, double brightness) const;
  double paintCoverage(const Place& place) const;
  double crossingCoverage(const Place& place) const;

  const StreetMap& streets_;
  StreetStyle style_;
  const TextureTiles& tiles_;
  std::vector<Crossing> crossings_;
  std::uint64_t seed_;
};

}  // namespace rotrocc
