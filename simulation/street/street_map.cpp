#include "simulation/street/street_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

constexpr double kSampling_m = 0.5;  // sampling of the center lines
constexpr double kCell_m = 0.5;      // cell size of the raster

Eigen::Vector2d level(const Eigen::Vector3d& v) {
  return {v.x(), v.z()};
}

}  // namespace

StreetMap::StreetMap(const std::vector<Path>& center_lines, double reach_m) : reach_m_(reach_m) {
  for (std::size_t i = 0; i < center_lines.size(); ++i) {
    addSamples(center_lines[i], static_cast<int>(i));
  }
  makeRaster();
}

void StreetMap::addSamples(const Path& path, int street) {
  for (double s = 0.0; s < path.length_m(); s += kSampling_m) {
    const double bend = path.heading_rad(s + kSampling_m) - path.heading_rad(s - kSampling_m);
    samples_.push_back({level(path.position(s)),
                        level(path.direction(s)).normalized(),
                        level(path.right(s)),
                        s,
                        std::remainder(bend, 2.0 * M_PI) / (2.0 * kSampling_m),
                        street});
  }
}

void StreetMap::makeRaster() {
  if (samples_.empty()) return;
  Eigen::AlignedBox2d box;
  for (const Sample& sample : samples_) box.extend(sample.at);
  origin_ = box.min() - Eigen::Vector2d::Constant(reach_m_);
  columns_ = static_cast<int>(std::ceil((box.sizes().x() + 2.0 * reach_m_) / kCell_m));
  rows_ = static_cast<int>(std::ceil((box.sizes().y() + 2.0 * reach_m_) / kCell_m));
  const auto cells = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  nearest_.assign(cells, -1);
  std::vector<float> squared_distances(cells, std::numeric_limits<float>::max());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    markAround(static_cast<std::int32_t>(i), squared_distances);
  }
}

void StreetMap::markAround(std::int32_t sample, std::vector<float>& squared_distances) {
  const Eigen::Vector2d center = (samples_[sample].at - origin_) / kCell_m;
  const double reach = reach_m_ / kCell_m;
  const int first_row = std::max(0, static_cast<int>(center.y() - reach));
  const int last_row = std::min(rows_ - 1, static_cast<int>(center.y() + reach));
  const int first_column = std::max(0, static_cast<int>(center.x() - reach));
  const int last_column = std::min(columns_ - 1, static_cast<int>(center.x() + reach));
  for (int row = first_row; row <= last_row; ++row) {
    for (int column = first_column; column <= last_column; ++column) {
      const auto squared =
          static_cast<float>((Eigen::Vector2d(column + 0.5, row + 0.5) - center).squaredNorm());
      const std::size_t cell = static_cast<std::size_t>(row) * columns_ + column;
      if (squared > reach * reach || squared >= squared_distances[cell]) continue;
      squared_distances[cell] = squared;
      nearest_[cell] = sample;
    }
  }
}

const StreetMap::Sample* StreetMap::nearestSample(double x, double z) const {
  const int column = floorToInt((x - origin_.x()) / kCell_m);
  const int row = floorToInt((z - origin_.y()) / kCell_m);
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return nullptr;
  const std::int32_t nearest = nearest_[static_cast<std::size_t>(row) * columns_ + column];
  return nearest < 0 ? nullptr : &samples_[nearest];
}

bool StreetMap::locate(double x, double z, StreetPoint& point) const {
  const Sample* nearest = nearestSample(x, z);
  if (nearest == nullptr) return false;
  const Sample& sample = *nearest;
  const Eigen::Vector2d offset = Eigen::Vector2d(x, z) - sample.at;
  const double along = offset.dot(sample.ahead);
  const double across = offset.dot(sample.right);
  // The line continues as an arc with its center 1 / curvature to the right.
  const double stretch = std::max(0.2, 1.0 - sample.curvature_per_m * across);
  point.street = sample.street;
  point.station_m = sample.station_m + along / stretch;
  point.right_m = across - 0.5 * along * along * sample.curvature_per_m / stretch;
  point.station_gradient = sample.ahead / stretch;
  point.right_gradient = sample.right;
  return true;
}

double StreetMap::distance(double x, double z) const {
  const Sample* nearest = nearestSample(x, z);
  if (nearest == nullptr) return reach_m_;
  return std::min(reach_m_, (Eigen::Vector2d(x, z) - nearest->at).norm());
}

}  // namespace rotrocc
