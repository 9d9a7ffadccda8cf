#include "simulation/scene/lamps.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rotrocc {
namespace {

constexpr double kCell_m = 4.0;
constexpr double kSize_m = 0.4;  // of a lamp: it is not brighter from nearer than that

}  // namespace

Lamps::Lamps(std::vector<Lamp> lamps, double reach_m, double ambient)
    : lamps_(std::move(lamps)), reach_m_(reach_m), ambient_(ambient) {
  Eigen::AlignedBox2d area;
  for (const Lamp& lamp : lamps_)
    area.extend(Eigen::Vector2d(lamp.position.x(), lamp.position.z()));
  if (area.isEmpty()) return;
  area.extend(Eigen::Vector2d(area.min() - Eigen::Vector2d::Constant(reach_m)));
  area.extend(Eigen::Vector2d(area.max() + Eigen::Vector2d::Constant(reach_m)));
  grid_ = GroundGrid::over(area, kCell_m);
  near_.resize(static_cast<std::size_t>(grid_.columns) * grid_.rows);
  for (std::size_t i = 0; i < lamps_.size(); ++i) {
    const Eigen::Vector3d& at = lamps_[i].position;
    for (int row = grid_.row(at.z() - reach_m); row <= grid_.row(at.z() + reach_m); ++row) {
      for (int column = grid_.column(at.x() - reach_m); column <= grid_.column(at.x() + reach_m);
           ++column) {
        if (!grid_.contains(column, row)) continue;
        near_[static_cast<std::size_t>(row) * grid_.columns + column].push_back(
            static_cast<std::int32_t>(i));
      }
    }
  }
}

template <class Each>
void Lamps::forNear(const Eigen::Vector3d& position, Each&& each) const {
  const int column = grid_.column(position.x());
  const int row = grid_.row(position.z());
  if (!grid_.contains(column, row)) return;
  for (const std::int32_t lamp : near_[static_cast<std::size_t>(row) * grid_.columns + column]) {
    each(lamps_[static_cast<std::size_t>(lamp)]);
  }
}

double Lamps::direct(const Lamp& lamp,
                     const Eigen::Vector3d& position,
                     const Eigen::Vector3d& normal) const {
  const Eigen::Vector3d towards = lamp.position - position;
  const double squared = towards.squaredNorm();
  const double window = 1.0 - squared / (reach_m_ * reach_m_);
  const double facing = normal.dot(towards);
  if (window <= 0.0 || facing <= 0.0) return 0.0;
  const double distance = std::sqrt(squared);
  // Half of it downwards, by the cosine, half to all sides.
  const double beam = 0.5 + 0.5 * std::max(0.0, -towards.y() / distance);
  const double strength = lamp.power / (squared + kSize_m * kSize_m);
  return strength * beam * (facing / distance) * window * window;
}

double Lamps::illumination(const Eigen::Vector3d& position,
                           const Eigen::Vector3d& normal,
                           double share) const {
  double sum = 0.0;
  forNear(position, [&](const Lamp& lamp) { sum += direct(lamp, position, normal); });
  return ambient_ * (1.0 - 0.2 * normal.y()) + share * sum;  // y points down
}

double Lamps::reaching(const SceneGeometry& scene, const Eigen::Vector3d& position) const {
  constexpr double kPixel_m = 0.002;
  double all = 0.0;
  double seen = 0.0;
  forNear(position, [&](const Lamp& lamp) {
    const double light = direct(lamp, position, -Eigen::Vector3d::UnitY());
    if (light <= 0.0) return;
    all += light;
    SceneHit hit;
    const Ray ray = {position, lamp.position - position};
    if (!scene.trace(ray, {0.005, 0.995}, kPixel_m, hit)) seen += light;
  });
  return all > 0.0 ? seen / all : 1.0;
}

}  // namespace rotrocc
