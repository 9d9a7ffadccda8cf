#include "simulation/surfaces/shadows.h"

#include <limits>

#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "simulation/each_row.h"
#include "simulation/surfaces/coverage.h"
#include "simulation/surfaces/sky.h"

namespace rotrocc {
namespace {

constexpr double kShadowCell_m = 0.2;
constexpr double kShadowReach_m = 14.0;

/// Share of the sun that reaches a place among bodies: 0 or 1.
double sunAt(const SceneGeometry& scene, const Eigen::Vector3d& position) {
  constexpr double kPixel_m = 0.002;  // leaves let some of the light through
  const Ray ray = {position, directionToSun()};
  const RayRange range = {0.02, std::numeric_limits<double>::infinity()};
  return scene.isBlocked(ray, range, kPixel_m) ? 0.0 : 1.0;
}

}  // namespace

GroundShadows::GroundShadows(const SceneGeometry& scene, const StreetMap& streets)
    : origin_(scene.terrain().grid().origin) {
  const GroundGrid& grid = scene.terrain().grid();
  const int columns = static_cast<int>(grid.columns * grid.cell_m / kShadowCell_m);
  const int rows = static_cast<int>(grid.rows * grid.cell_m / kShadowCell_m);
  lit_ = cv::Mat(rows, columns, CV_8UC1, cv::Scalar(255));
  eachRow(rows, [&](int row) {
    const double z = origin_.y() + kShadowCell_m * (row + 0.5);
    for (int column = 0; column < columns; ++column) {
      const double x = origin_.x() + kShadowCell_m * (column + 0.5);
      if (streets.distance(x, z) >= kShadowReach_m) continue;
      const Eigen::Vector3d ground(x, scene.terrain().height(x, z) - 0.01, z);
      lit_.at<uchar>(row, column) = cv::saturate_cast<uchar>(255.0 * sunAt(scene, ground));
    }
  });
  cv::GaussianBlur(lit_, lit_, cv::Size(5, 5), 0.9);
}

double GroundShadows::lit(double x, double z) const {
  const double u = (x - origin_.x()) / kShadowCell_m - 0.5;
  const double v = (z - origin_.y()) / kShadowCell_m - 0.5;
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

double sunlitTop(const SceneGeometry& scene, const Body& body) {
  const Eigen::AlignedBox3d& box = body.bounds();
  const Eigen::Vector3d center = box.center();
  double reached = 0.0;
  for (const double x : {-0.5, 0.5}) {
    for (const double z : {-0.5, 0.5}) {
      const Eigen::Vector3d point(
          center.x() + x * box.sizes().x(), box.min().y() - 0.05, center.z() + z * box.sizes().z());
      reached += sunAt(scene, point);
    }
  }
  return 0.25 * reached;
}

}  // namespace rotrocc
