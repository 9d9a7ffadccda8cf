#pragma once

#include <cstdint>
#include <vector>

#include "simulation/scene/light.h"
#include "simulation/scene/terrain.h"

namespace rotrocc {

/// A lamp that shines downwards, and to all sides.
struct Lamp {
  Eigen::Vector3d position;
  double power;  ///< illumination 1 m below it, without other light
};

/// Lamps in a closed place, and what its surfaces scatter.
class Lamps : public Light {
 public:
  /// A lamp shines up to `reach_m`, fading; `ambient` is the scattered light of an upright surface.
  Lamps(std::vector<Lamp> lamps, double reach_m, double ambient);

  double illumination(const Eigen::Vector3d& position,
                      const Eigen::Vector3d& normal,
                      double share) const override;
  double reaching(const SceneGeometry& scene, const Eigen::Vector3d& position) const override;

 private:
  /// What one lamp gives to a surface without obstacles.
  double direct(const Lamp& lamp,
                const Eigen::Vector3d& position,
                const Eigen::Vector3d& normal) const;

  /// Calls each(lamp) for those that may reach a position.
  template <class Each>
  void forNear(const Eigen::Vector3d& position, Each&& each) const;

  std::vector<Lamp> lamps_;
  double reach_m_;
  double ambient_;
  GroundGrid grid_;
  std::vector<std::vector<std::int32_t>> near_;  // lamps that may reach each cell
};

}  // namespace rotrocc
