#pragma once

#include "simulation/counter_random.h"
#include "simulation/surfaces/material.h"
#include "simulation/surfaces/texture_tiles.h"

namespace rotrocc {

/// Surfaces of a workshop. Heights are above the ground; the textures must outlive the materials.

/// Painted walls with a darker band below and a row of windows on one side, under a ceiling of
/// corrugated sheet. For a box that is seen from inside.
class HallShell : public Material {
 public:
  /// Windows on the wall at the least x, in [window_low_m, window_high_m].
  HallShell(const TextureTiles& tiles, double window_low_m, double window_high_m)
      : tiles_(tiles), window_low_m_(window_low_m), window_high_m_(window_high_m) {}

  double reflectance(const SurfacePoint& point) const override;
  double glow(const SurfacePoint& point) const override;

 private:
  double wall(const TexturePoint& at) const;
  double ceiling(const TexturePoint& at) const;

  /// Share of panes at a place on the wall with windows.
  double panes(const TexturePoint& at) const;

  const TextureTiles& tiles_;
  double window_low_m_;
  double window_high_m_;
};

/// Screed with joints, stains and painted lines.
class HallFloor : public Material {
 public:
  explicit HallFloor(const TextureTiles& tiles) : tiles_(tiles) {}
  double reflectance(const SurfacePoint& point) const override;

 private:
  const TextureTiles& tiles_;
};

/// Paint or metal with faint fine stains, seen from near as well.
class Coated : public Material {
 public:
  Coated(const TextureTiles& tiles, double tone, double contrast)
      : tiles_(tiles), tone_(tone), contrast_(contrast) {}
  double reflectance(const SurfacePoint& point) const override;

 private:
  const TextureTiles& tiles_;
  double tone_;
  double contrast_;
};

/// Slanting stripes up to a height, coated above.
class Hazard : public Material {
 public:
  Hazard(const TextureTiles& tiles, double tone, double top_m)
      : coat_(tiles, tone, 0.3), top_m_(top_m) {}
  double reflectance(const SurfacePoint& point) const override;

 private:
  Coated coat_;
  double top_m_;
};

/// A carton with tape and a label, around `centre` of its body.
class Carton : public Material {
 public:
  Carton(const TextureTiles& tiles, const Eigen::Vector3d& centre, RandomStream& random);
  double reflectance(const SurfacePoint& point) const override;

 private:
  const TextureTiles& tiles_;
  Eigen::Vector3d centre_;
  double tone_;
  int line_;               // of the writing
  Eigen::Vector2d label_;  // its middle from the middle of the face
  double label_m_;         // half its width
};

/// A panel of switches and instruments.
class ControlPanel : public Material {
 public:
  ControlPanel(const TextureTiles& tiles, double tone, std::uint64_t key)
      : tiles_(tiles), tone_(tone), key_(key) {}
  double reflectance(const SurfacePoint& point) const override;

 private:
  const TextureTiles& tiles_;
  double tone_;
  std::uint64_t key_;
};

/// A notice or picture on a board.
class Notice : public Material {
 public:
  Notice(const TextureTiles& tiles, const Eigen::Vector3d& centre, RandomStream& random);
  double reflectance(const SurfacePoint& point) const override;

 private:
  const TextureTiles& tiles_;
  Eigen::Vector3d centre_;
  double board_;
  double ink_;
  double line_m_;
  bool picture_;
};

/// A lit tube.
class LitTube : public Material {
 public:
  double reflectance(const SurfacePoint& /*point*/) const override { return 0.6; }
  double glow(const SurfacePoint& point) const override {
    return point.normal.y() > 0.5 ? 1.2 : 0.3;
  }
};

}  // namespace rotrocc
