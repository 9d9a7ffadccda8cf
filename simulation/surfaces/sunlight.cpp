#include "simulation/surfaces/sunlight.h"

#include <limits>

#include <opencv2/imgproc.hpp>

#include "simulation/rows.h"
#include "simulation/surfaces/coverage.h"
#include "simulation/surfaces/lighting.h"

namespace rotrocc {
namespace {

/// Height (y) of the ground, or of what belongs to it.
double topOfGround(const SceneGeometry& scene, double x, double z) {
  constexpr double kAbove_m = 10.0;
  constexpr double kPixel_m = 0.002;
  double top = scene.terrain().height(x, z);
  const Ray down = {{x, top - kAbove_m, z}, Eigen::Vector3d::UnitY()};
  for (const std::int32_t index : scene.bodiesAround(x, z)) {
    const Body& body = scene.bodies()[static_cast<std::size_t>(index)];
    const RayRange range = {0.0, top - down.origin.y()};
    BodyHit hit;
    if (body.is_ground && body.intersect(down, range, kPixel_m, hit))
      top = down.at(hit.distance).y();
  }
  return top;
}

}  // namespace

double Daylight::illumination(const Eigen::Vector3d& /*position*/,
                              const Eigen::Vector3d& normal,
                              double share) const {
  return daylight(lighting_, normal, share);
}

double Daylight::reaching(const SceneGeometry& scene, const Eigen::Vector3d& position) const {
  constexpr double kPixel_m = 0.002;  // leaves let some of the light through
  SceneHit hit;
  const Ray ray = {position, directionToSun()};
  const RayRange range = {0.02, std::numeric_limits<double>::infinity()};
  return scene.trace(ray, range, kPixel_m, hit) ? 0.0 : 1.0;
}

GroundShadows::GroundShadows(const SceneGeometry& scene,
                             const Light& light,
                             double cell_m,
                             const std::function<bool(double, double)>& covers)
    : cell_m_(cell_m), origin_(scene.terrain().grid().origin) {
  const GroundGrid& grid = scene.terrain().grid();
  const int columns = static_cast<int>(grid.columns * grid.cell_m / cell_m);
  const int rows = static_cast<int>(grid.rows * grid.cell_m / cell_m);
  lit_ = cv::Mat(rows, columns, CV_8UC1, cv::Scalar(255));
  forEachRow(rows, [&](int row) {
    const double z = origin_.y() + cell_m * (row + 0.5);
    for (int column = 0; column < columns; ++column) {
      const double x = origin_.x() + cell_m * (column + 0.5);
      if (!covers(x, z)) continue;
      const Eigen::Vector3d ground(x, topOfGround(scene, x, z) - 0.01, z);
      lit_.at<uchar>(row, column) = cv::saturate_cast<uchar>(255.0 * light.reaching(scene, ground));
    }
  });
  cv::GaussianBlur(lit_, lit_, cv::Size(5, 5), 0.9);
}

double GroundShadows::lit(double x, double z) const {
  const double u = (x - origin_.x()) / cell_m_ - 0.5;
  const double v = (z - origin_.y()) / cell_m_ - 0.5;
  const int column = floorToInt(u);
  const int row = floorToInt(v);
  if (column < 0 || row < 0 || column + 1 >= lit_.cols || row + 1 >= lit_.rows) return 1.0;
  const uchar* upper = lit_.ptr(row) + column;
  const uchar* lower = lit_.ptr(row + 1) + column;
  const double a = u - column;
  const double top = upper[0] + a * (upper[1] - upper[0]);
  const double bottom = lower[0] + a * (lower[1] - lower[0]);
  return (top + (v - row) * (bottom - top)) / 255.0;
}

double litTop(const SceneGeometry& scene, const Light& light, const Body& body) {
  const Eigen::AlignedBox3d& box = body.bounds();
  const Eigen::Vector3d centre = box.center();
  double reached = 0.0;
  for (const double x : {-0.5, 0.5}) {
    for (const double z : {-0.5, 0.5}) {
      const Eigen::Vector3d point(
          centre.x() + x * box.sizes().x(), box.min().y() - 0.05, centre.z() + z * box.sizes().z());
      reached += light.reaching(scene, point);
    }
  }
  return 0.25 * reached;
}

}  // namespace rotrocc
