#include "support/synthetic_sequence.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

#include <Eigen/Geometry>
#include <opencv2/imgcodecs.hpp>

#include "rotrocc/trajectory.h"
#include "support/synthetic_scene.h"

namespace rotrocc {
namespace {

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
