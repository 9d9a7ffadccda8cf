#include "support/synthetic_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <sstream>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "rotrocc/trajectory.h"

namespace rotrocc {
namespace {

/// A plane of the scene: `axis` has the coordinate `offset_m`.
struct Plane {
  int axis;
  double offset_m;
};

constexpr std::array<Plane, 5> kPlanes = {
    {{1, 1.65}, {0, -7.0}, {0, 6.0}, {2, 90.0}, {1, -9.0}}};  // road, walls, end, canopy

struct Hit {
  double distance;  // in units of the ray's length
  int plane;
};

Hit intersect(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
  Hit nearest{std::numeric_limits<double>::max(), 0};
  for (std::size_t i = 0; i < kPlanes.size(); ++i) {
    const double distance = (kPlanes[i].offset_m - origin[kPlanes[i].axis]) / ray[kPlanes[i].axis];
    if (distance > 0.0 && distance < nearest.distance) nearest = {distance, static_cast<int>(i)};
  }
  return nearest;
}

/// A number from 0 to 1 for each point of a lattice.
double latticeValue(std::int64_t x, std::int64_t y, int layer) {
  std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ULL ^
                    static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FULL ^
                    static_cast<std::uint64_t>(layer) * 0x165667B19E3779F9ULL;
  h ^= h >> 29;
  h *= 0xBF58476D1CE4E5B9ULL;
  h ^= h >> 32;
  return static_cast<double>(h & 0xFFFFFF) / 0xFFFFFF;
}

/// Lattice values with smooth transitions.
double smoothNoise(double x, double y, int layer) {
  const double fx = std::floor(x);
  const double fy = std::floor(y);
  const auto ix = static_cast<std::int64_t>(fx);
  const auto iy = static_cast<std::int64_t>(fy);
  const auto ease = [](double t) { return t * t * (3.0 - 2.0 * t); };
  const double u = ease(x - fx);
  const double v = ease(y - fy);
  const double top = (1.0 - u) * latticeValue(ix, iy, layer) + u * latticeValue(ix + 1, iy, layer);
  const double bottom =
      (1.0 - u) * latticeValue(ix, iy + 1, layer) + u * latticeValue(ix + 1, iy + 1, layer);
  return (1.0 - v) * top + v * bottom;
}

/// Octaves of noise from 3 m down to what `footprint_m`, the size of a pixel there, can still show.
double texture(double x, double y, int plane, double footprint_m) {
  double value = 0.0;
  double weights = 0.0;
  int layer = 16 * plane;
  for (double wavelength_m = 3.0; wavelength_m > 0.02; wavelength_m *= 0.5, ++layer) {
    const double visible = std::clamp(0.5 * wavelength_m / footprint_m - 1.0, 0.0, 1.0);
    if (visible == 0.0) break;
    value += visible * (smoothNoise(x / wavelength_m, y / wavelength_m, layer) - 0.5);
    weights += 0.35;
  }
  return weights == 0.0 ? 0.0 : value / weights;
}

namespace fs = std::filesystem;

constexpr std::int64_t kPeriod_ns = 100000000;

Eigen::Isometry3d poseOf(int index) {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  const double yaw_rad = 0.05 * std::sin(0.35 * index);
  T_world_camera.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  T_world_camera.translation() << 0.0, 0.0, 0.5 * index;
  return T_world_camera;
}

void writeCalibration(const fs::path& path, const StereoCamera& camera) {
  std::ofstream file(path);
  file << std::setprecision(17);
  for (const bool right : {false, true}) {
    file << (right ? "P1: " : "P0: ") << camera.fx << " 0 " << (right ? camera.cx_right : camera.cx)
         << ' ' << (right ? -camera.fx * camera.baseline_m : 0.0) << " 0 " << camera.fy << ' '
         << camera.cy << " 0 0 0 1 0\n";
  }
}

}  // namespace

StereoCamera SyntheticScene::defaultCamera() {
  StereoCamera camera;
  camera.width = 620;
  camera.height = 188;
  camera.fx = camera.fy = 360.0;
  camera.cx = camera.cx_right = 305.0;
  camera.cy = 92.0;
  camera.baseline_m = 0.54;
  return camera;
}

StereoPair SyntheticScene::render(const Eigen::Isometry3d& T_world_camera,
                                  std::int64_t stamp_ns) const {
  StereoPair pair;
  pair.stamp_ns = stamp_ns;
  pair.left = renderImage(T_world_camera, camera_.cx);
  const Eigen::Translation3d to_the_right(camera_.baseline_m, 0.0, 0.0);
  pair.right = renderImage(T_world_camera * to_the_right, camera_.cx_right);
  return pair;
}

cv::Mat SyntheticScene::renderImage(const Eigen::Isometry3d& T_world_camera, double cx) const {
  cv::Mat image(camera_.height, camera_.width, CV_8UC1);
  const Eigen::Vector3d origin = T_world_camera.translation();
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const Eigen::Vector3d ray =
          T_world_camera.linear() *
          Eigen::Vector3d((x - cx) / camera_.fx, (y - camera_.cy) / camera_.fy, 1.0);
      const Hit hit = intersect(origin, ray);
      const int axis = kPlanes[static_cast<std::size_t>(hit.plane)].axis;
      const Eigen::Vector3d point = origin + hit.distance * ray;
      const double u = axis == 0 ? point.y() : point.x();
      const double v = axis == 2 ? point.y() : point.z();
      // A plane seen at a flat angle spreads a pixel along the view, but not across it: the mean.
      const double tilt = std::sqrt(std::max(std::abs(ray[axis]) / ray.norm(), 0.02));
      const double footprint_m = hit.distance / camera_.fx / tilt;
      const double gray = 128.0 + 110.0 * texture(u, v, hit.plane, footprint_m);
      image.at<uchar>(y, x) = cv::saturate_cast<uchar>(gray);
    }
  }
  return image;
}

Eigen::Vector3d SyntheticScene::pointAt(const Eigen::Isometry3d& T_world_camera,
                                        const Eigen::Vector2d& pixel) const {
  const Eigen::Vector3d ray = camera_.ray(pixel);
  return intersect(T_world_camera.translation(), T_world_camera.linear() * ray).distance * ray;
}

void SyntheticScene::addNoise(StereoPair& pair, double sigma, std::uint64_t seed) {
  cv::RNG generator(seed);
  for (cv::Mat* image : {&pair.left, &pair.right}) {
    cv::Mat noise(image->size(), CV_16SC1);
    generator.fill(noise, cv::RNG::NORMAL, 0.0, sigma);
    cv::add(*image, noise, *image, cv::noArray(), CV_8U);
  }
}

void SyntheticScene::lowerRight(StereoPair& pair, double rows) {
  const cv::Mat down = (cv::Mat_<double>(2, 3) << 1.0, 0.0, 0.0, 0.0, 1.0, rows);
  cv::Mat moved;
  cv::warpAffine(pair.right, moved, down, pair.right.size());
  pair.right = moved;
}

void writeSyntheticSequence(const std::string& directory, int pairs) {
  const fs::path root(directory);
  fs::create_directories(root / "image_0");
  fs::create_directories(root / "image_1");
  const SyntheticScene scene;
  writeCalibration(root / "calib.txt", scene.camera());
  TrajectoryWriter poses((root / "poses.txt").string(), TrajectoryFormat::kKitti);
  std::ofstream times(root / "times.txt");
  for (int index = 0; index < pairs; ++index) {
    const StampedPose pose = {index * kPeriod_ns, poseOf(index)};
    const StereoPair pair = scene.render(pose.T_world_body, pose.stamp_ns);
    std::ostringstream name;
    name << std::setw(6) << std::setfill('0') << index << ".png";
    cv::imwrite((root / "image_0" / name.str()).string(), pair.left);
    cv::imwrite((root / "image_1" / name.str()).string(), pair.right);
    times << 1e-9 * static_cast<double>(pose.stamp_ns) << '\n';
    poses.write(pose);
  }
}

}  // namespace rotrocc
