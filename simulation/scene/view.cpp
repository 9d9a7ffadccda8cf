#include "simulation/scene/view.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rotrocc {
namespace {

constexpr double kNearest_m = 0.05;
constexpr double kFarthest_m = 500.0;
constexpr double kSmallest_px = 0.3;  // smaller bodies are not visible
constexpr int kTile_px = 16;

}  // namespace

View::View(const std::vector<Body>& standing,
           const std::vector<Body>& moving,
           const StereoCamera& camera,
           const Eigen::Isometry3d& T_world_camera)
    : standing_(standing),
      moving_(moving),
      camera_(camera),
      origin_(T_world_camera.translation()),
      axes_(T_world_camera.linear()),
      spread_{axes_.col(0) / camera.fx, axes_.col(1) / camera.fy} {
  const int count = standingCount() + static_cast<int>(moving_.size());
  for (int number = 0; number < count; ++number) addBody(number, T_world_camera);
  std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
    return a.nearest_m < b.nearest_m;
  });
  sortIntoTiles();
}

const Body& View::body(int number) const {
  return number < standingCount() ? standing_[static_cast<std::size_t>(number)]
                                  : moving_[static_cast<std::size_t>(number - standingCount())];
}

void View::addBody(int number, const Eigen::Isometry3d& T_world_camera) {
  const Body& solid = body(number);
  const double away = (solid.bounds().center() - origin_).norm();
  const double reach = 0.5 * solid.bounds().sizes().norm();
  if (away - reach > kFarthest_m) return;
  if ((solid.bounds().center() - origin_).dot(axes_.col(2)) < -reach) return;  // behind
  const Eigen::Isometry3d T_body_camera = solid.T_world_body().inverse() * T_world_camera;
  const Eigen::Isometry3d T_camera_body = T_body_camera.inverse();
  for (std::size_t part = 0; part < solid.parts().size(); ++part) {
    Candidate candidate;
    if (!cover(solid.parts()[part].shape->bounds(), T_camera_body, candidate)) continue;
    candidate.body = number;
    candidate.part = static_cast<int>(part);
    candidate.origin = T_body_camera.translation();
    candidate.R_body_camera = T_body_camera.linear();
    candidates_.push_back(candidate);
  }
}

bool View::cover(const Eigen::AlignedBox3d& box,
                 const Eigen::Isometry3d& T_camera_body,
                 Candidate& candidate) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::AlignedBox2d pixels;
  candidate.nearest_m = kInfinity;
  const auto add = [&](const Eigen::Vector3d& point) {
    candidate.nearest_m = std::min(candidate.nearest_m, point.z());
    pixels.extend(camera_.project(point));
  };
  // Corners, and where edges pass the nearest visible plane.
  const auto corner = [&](int index) -> Eigen::Vector3d {
    return T_camera_body * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(index));
  };
  for (int from = 0; from < 8; ++from) {
    const Eigen::Vector3d a = corner(from);
    if (a.z() < kNearest_m) continue;
    add(a);
    for (const int axis : {1, 2, 4}) {
      const Eigen::Vector3d b = corner(from ^ axis);
      if (b.z() < kNearest_m) add(a + (kNearest_m - a.z()) / (b.z() - a.z()) * (b - a));
    }
  }
  if (pixels.isEmpty() || pixels.sizes().maxCoeff() < kSmallest_px) return false;
  const Eigen::AlignedBox2d image(Eigen::Vector2d(-0.5, -0.5),
                                  Eigen::Vector2d(camera_.width - 0.5, camera_.height - 0.5));
  if (!pixels.intersects(image)) return false;
  pixels.clamp(image);
  candidate.pixels = {pixels.min().x(), pixels.min().y(), pixels.sizes().x(), pixels.sizes().y()};
  return true;
}

void View::sortIntoTiles() {
  tile_columns_ = (camera_.width + kTile_px - 1) / kTile_px;
  const int tile_rows = (camera_.height + kTile_px - 1) / kTile_px;
  tiles_.resize(static_cast<std::size_t>(tile_columns_ * tile_rows));
  const auto tileOf = [](double pixel, int tiles) {
    return std::clamp(static_cast<int>(std::floor((pixel + 0.5) / kTile_px)), 0, tiles - 1);
  };
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const cv::Rect2d& pixels = candidates_[i].pixels;
    const int last_row = tileOf(pixels.y + pixels.height, tile_rows);
    const int last_column = tileOf(pixels.x + pixels.width, tile_columns_);
    for (int row = tileOf(pixels.y, tile_rows); row <= last_row; ++row) {
      for (int column = tileOf(pixels.x, tile_columns_); column <= last_column; ++column) {
        tiles_[static_cast<std::size_t>(row * tile_columns_ + column)].push_back(
            static_cast<std::int32_t>(i));
      }
    }
  }
}

bool View::intersect(double x, double y, const RayRange& range, BodyHit& hit, int& number) const {
  const int column = std::clamp(static_cast<int>((x + 0.5) / kTile_px), 0, tile_columns_ - 1);
  const int row = std::clamp(static_cast<int>((y + 0.5) / kTile_px),
                             0,
                             static_cast<int>(tiles_.size()) / tile_columns_ - 1);
  const double pixel_m = 1.0 / camera_.fx;
  const Eigen::Vector3d direction = camera_.ray({x, y});
  RayRange nearer = range;
  bool found = false;
  for (const std::int32_t index : tiles_[static_cast<std::size_t>(row * tile_columns_ + column)]) {
    const Candidate& candidate = candidates_[static_cast<std::size_t>(index)];
    if (candidate.nearest_m >= nearer.to) break;
    const cv::Rect2d& pixels = candidate.pixels;
    if (x < pixels.x || y < pixels.y || x > pixels.x + pixels.width ||
        y > pixels.y + pixels.height) {
      continue;
    }
    const Ray own = {candidate.origin, candidate.R_body_camera * direction};
    if (!body(candidate.body).intersectPart(candidate.part, own, nearer, pixel_m, hit)) continue;
    nearer.to = hit.distance;
    number = candidate.body;
    found = true;
  }
  return found;
}

}  // namespace rotrocc
