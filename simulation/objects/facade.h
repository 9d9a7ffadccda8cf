#pragma once

#include <cstdint>

#include "simulation/surfaces/material.h"
#include "simulation/surfaces/texture_tiles.h"

namespace rotrocc {

/// Lengths in metres, brightnesses as reflectances.
struct FacadeStyle {
  double half_width = 6.0;  ///< of the front
  double half_depth = 5.0;
  int floors = 3;
  double floor_height = 3.0;
  double window_spacing = 2.6;
  double window_width = 1.2;
  double window_height = 1.5;
  double sill_height = 0.9;  ///< height of the windows above their floor
  double wall = 0.6;
  double frame = 0.8;
  double shutters = 0.0;  ///< their brightness; 0: none
  bool bricks = false;
  bool shop = false;  ///< large panes on the ground floor
  int door = 1;       ///< column of windows that it replaces
  std::uint64_t key = 0;
};

/// The walls of a house: windows with frames, sills and panes of different brightness, a door or a
/// shop, a plinth and ledges between the floors.
class Facade : public Material {
 public:
  /// The textures must outlive this object.
  Facade(const FacadeStyle& style, const TextureTiles& tiles);

  double reflectance(const SurfacePoint& point) const override;
  double gloss(const SurfacePoint& point) const override;
  double glow(const SurfacePoint& point) const override;

 private:
  /// Position of a pixel relative to the windows of its wall.
  struct Place {
    TexturePoint point;
    double u, v;           // from the left lower corner of the first window's cell [m]
    double width, height;  // of the pixel [m]
    double windows;        // share of the pixel on the part of the wall that has windows
    double column, row;    // of the window
    double resolved;       // 1: single windows are resolved, 0: they are not
  };

  double halfRow(double half_wall) const;
  Place placeOf(const SurfacePoint& point) const;
  double wall(const Place& place) const;
  double glassCoverage(const Place& place) const;
  double luck(const Place& place) const;
  double pane(const Place& place) const;
  double windowCoverage(const Place& place, double margin_m) const;
  double withWindows(const Place& place, double brightness) const;
  double withGroundFloor(const Place& place, double brightness) const;
  double withLedges(const Place& place, double brightness) const;

  FacadeStyle style_;
  const TextureTiles& tiles_;
  double front_half_row_;  // half of the width of all windows in a row [m]
  double side_half_row_;
};

}  // namespace rotrocc
