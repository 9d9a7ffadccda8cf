#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// A textured street between two walls, rendered with exact poses: the ground truth of tests.
///
/// The world's axes are those of a camera that looks along the street: x right, y down, z forward.
/// The road lies 1.65 m below the origin, the walls are 7 m to the left and 6 m to the right, and
/// one 90 m ahead closes the street. The texture is band-limited noise, so images show no aliasing.
class SyntheticScene {
 public:
  /// Half of KITTI's size, with its field of view and baseline.
  static StereoCamera defaultCamera();

  explicit SyntheticScene(const StereoCamera& camera = defaultCamera()) : camera_(camera) {}

  const StereoCamera& camera() const { return camera_; }

  /// Both images of a left camera at `T_world_camera`, without noise.
  StereoPair render(const Eigen::Isometry3d& T_world_camera, std::int64_t stamp_ns) const;

  /// The point a left pixel sees, in the camera's frame [m]; every ray hits something.
  Eigen::Vector3d pointAt(const Eigen::Isometry3d& T_world_camera,
                          const Eigen::Vector2d& pixel) const;

  /// Adds Gaussian noise of `sigma` gray levels, the same for the same seed.
  static void addNoise(StereoPair& pair, double sigma, std::uint64_t seed);

  /// Moves the right image down, as that of a pitched camera.
  static void lowerRight(StereoPair& pair, double rows);

 private:
  cv::Mat renderImage(const Eigen::Isometry3d& T_world_camera, double cx) const;

  StereoCamera camera_;
};

/// Writes `pairs` pairs of a drive along the street of SyntheticScene, 0.5 m and up to 1 degree
/// from each to the next at 10 Hz, with ground truth, in the layout of KITTI.
void writeSyntheticSequence(const std::string& directory, int pairs);

}  // namespace rotrocc
