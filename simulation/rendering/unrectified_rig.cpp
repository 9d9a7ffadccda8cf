#include "simulation/rendering/unrectified_rig.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace rotrocc {
namespace {

/// What differs between the cameras.
struct Individual {
  double focal_ratio;          // of that of the nominal camera
  Eigen::Vector2d center_px;   // of the principal point from the middle of the image
  Eigen::Vector3d turn_rad;    // about x, y, z
  std::vector<double> radtan;  // as of EuRoC
  std::vector<double> equidistant;
};

const Individual kLeft = {1.05,
                          {-8.3, 8.9},
                          {0.0070, -0.0081, 0.0014},
                          {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05},
                          {0.0035, 0.0007, -0.0021, 0.0002}};
const Individual kRight = {1.0475,
                           {4.5, 15.7},
                           {-0.0071, -0.0077, -0.0036},
                           {-0.28368365, 0.07451284, -0.00010473, -3.55590700e-05},
                           {0.0034, 0.0018, -0.0027, 0.0003}};

RawCamera rawCamera(const StereoCamera& nominal, const std::string& lens, const Individual& own) {
  // The offsets are those of an image 752 px wide.
  const Eigen::Vector2d offset = nominal.width / 752.0 * own.center_px;
  RawCamera raw;
  raw.width = nominal.width;
  raw.height = nominal.height;
  raw.fx = own.focal_ratio * nominal.fx;
  raw.fy = 0.997 * own.focal_ratio * nominal.fy;
  raw.cx = 0.5 * (nominal.width - 1) + offset.x();
  raw.cy = 0.5 * (nominal.height - 1) + offset.y();
  raw.R_rectified_raw = (Eigen::AngleAxisd(own.turn_rad.z(), Eigen::Vector3d::UnitZ()) *
                         Eigen::AngleAxisd(own.turn_rad.y(), Eigen::Vector3d::UnitY()) *
                         Eigen::AngleAxisd(own.turn_rad.x(), Eigen::Vector3d::UnitX()))
                            .toRotationMatrix();
  raw.distortion = {lens, lens == "radtan" ? own.radtan : own.equidistant};
  return raw;
}

/// Through an image that shows all that the raw one does, in the axes of the nominal camera.
PixelRays raysOf(const RawCamera& raw) {
  constexpr double kMaxSlope = 4.0;  // 76 degrees
  cv::Mat places(raw.height, raw.width, CV_64FC2);
  Eigen::AlignedBox2d bounds;
  for (int y = 0; y < raw.height; ++y) {
    std::vector<cv::Point2d> row;
    for (int x = 0; x < raw.width; ++x) row.emplace_back(x, y);
    const std::vector<Eigen::Vector3d> rays = raw.rays(row);
    for (int x = 0; x < raw.width; ++x) {
      const Eigen::Vector3d ray = raw.R_rectified_raw * rays[static_cast<std::size_t>(x)];
      const Eigen::Vector2d slope = ray.hnormalized();
      if (!(ray.z() > 0.0 && slope.norm() < kMaxSlope)) {
        throw std::invalid_argument(cv::format(
            "the lens looks farther than %g degrees from its axis: choose a longer focal "
            "length or a smaller image",
            std::atan(kMaxSlope) * 180.0 / M_PI));
      }
      const Eigen::Vector2d place(raw.fx * slope.x(), raw.fy * slope.y());
      places.at<cv::Vec2d>(y, x) = {place.x(), place.y()};
      bounds.extend(place);
    }
  }
  const Eigen::Vector2d first = bounds.min();
  PixelRays rays;
  rays.places = places - cv::Scalar(first.x(), first.y());
  rays.pinhole.fx = raw.fx;
  rays.pinhole.fy = raw.fy;
  rays.pinhole.cx = -first.x();
  rays.pinhole.cy = -first.y();
  rays.pinhole.width = static_cast<int>(std::ceil(bounds.sizes().x())) + 1;
  rays.pinhole.height = static_cast<int>(std::ceil(bounds.sizes().y())) + 1;
  return rays;
}

}  // namespace

UnrectifiedRig unrectifiedRig(const StereoCamera& nominal, const std::string& lens) {
  const RawCamera left = rawCamera(nominal, lens, kLeft);
  const RawCamera right = rawCamera(nominal, lens, kRight);
  return {{{left, raysOf(left)}, {right, raysOf(right)}}};
}

}  // namespace rotrocc
