#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "simulation/rendering/picture.h"

namespace rotrocc {

/// Rain between a scene and the sensors.
struct Rain {
  double drops = 0.0;          ///< on each lens shortly before it is wiped
  double streaks = 0.0;        ///< falling drops in sight, up to 6 m away
  double wiped_every_s = 6.0;  ///< each lens at times of its own

  /// Throws std::invalid_argument, naming the first value out of range.
  void check() const;
};

/// A drop on a lens, seen out of focus; in pixels of the image.
struct LensDrop {
  Eigen::Vector2d centre;
  double radius;
  double phase_rad;  ///< of its outline

  /// 0 in its centre, 1 on its outline.
  double distance(const Eigen::Vector2d& pixel) const;
};

/// The drops on a lens. They stay where they are, some creep down, until they are wiped off.
std::vector<LensDrop> dropsOnLens(const Rain& rain,
                                  const cv::Size& image,
                                  double time_s,
                                  std::uint64_t key);

/// The light (CV_32FC1) behind a lens with drops: each shows its surroundings blurred, smaller and
/// upside down.
cv::Mat throughDrops(const cv::Mat& light, const std::vector<LensDrop>& drops);

/// The way of a falling drop during an exposure, in the frame of a camera.
struct Streak {
  Eigen::Vector3d from;
  Eigen::Vector3d to;
  double diameter_m;
};

/// Drops in sight of a camera, which move by `way_m` during the exposure, as it sees it.
std::vector<Streak> fallingDrops(const Rain& rain,
                                 const StereoCamera& camera,
                                 const Eigen::Vector3d& way_m,
                                 std::uint64_t key);

/// The light with falling drops before the scene, which have this brightness.
cv::Mat throughStreaks(const cv::Mat& light,
                       const PixelRays& rays,
                       const std::vector<Streak>& streaks,
                       double brightness);

}  // namespace rotrocc
