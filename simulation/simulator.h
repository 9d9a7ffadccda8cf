#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "common/to_seconds.h"
#include "inertial/gyro_history.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"
#include "simulation/drives/scenario.h"
#include "simulation/kitti_camera.h"
#include "simulation/rendering/renderer.h"
#include "simulation/rendering/unrectified_rig.h"

namespace rotrocc {

/// Faults of a stereo rig that are not in its calibration file.
struct CameraFaults {
  double disparity_bias_px = 0.0;  ///< added to all disparities
  /// Of the right camera: about its z (roll), x (pitch), y (yaw).
  Eigen::Vector3d right_rotation_rad = Eigen::Vector3d::Zero();
  double row_offset_px = 0.0;      ///< of the right image: what it shows is this much lower
  double right_focal_ratio = 1.0;  ///< focal length of the right camera, over the nominal one
  double time_skew_s = 0.0;        ///< delay of the right camera
  double motion_blur_s = 0.0;      ///< exposure time, around the stamp
  double noise_sigma = 2.0;        ///< [gray levels], Gaussian, the same at any brightness

  /// True T_left_right of the rig.
  Eigen::Isometry3d rightCamera(const StereoCamera& camera) const;
};

struct SimulationOptions {
  StereoCamera camera = kittiCamera();
  std::string lens;  ///< of cameras whose images are not rectified: radtan or equidistant; or empty
  CameraFaults faults;
  double moving_share = 0.35;  ///< occupied share of the places for moving cars
  double rate_hz = 10.0;       ///< of scripted drives; recorded ones have stamps
  int frames = 0;              ///< largest number of frames; 0: all
  std::uint64_t seed = 1;
  std::uint64_t noise_seed = 1;  ///< of the noise of the images
};

/// A stereo pair with ground truth for the left image.
struct SimulatedFrame {
  StereoPair pair;
  cv::Mat depth;  ///< CV_64FC1 [m] at the centers of the pixels; infinite for the sky; empty for
                  ///< images that are not rectified
};

/// Renders frames in any order.
class Simulator {
 public:
  /// Throws std::invalid_argument, naming the first option out of range.
  Simulator(const Scenario& scenario, const SimulationOptions& options);

  const StereoCamera& camera() const { return options_.camera; }

  /// Set if the options have a lens.
  const std::optional<UnrectifiedRig>& unrectifiedRig() const { return unrectified_; }
  int size() const { return static_cast<int>(stamps_ns_.size()); }
  std::int64_t stamp_ns(int index) const { return stamps_ns_.at(index); }

  /// T_first_left, of the left camera.
  Eigen::Isometry3d pose(int index) const;

  /// At the left camera, from before the first frame until after the last one.
  std::vector<GyroSample> gyroscope() const;

  SimulatedFrame render(int index) const;

  /// The right image of that frame alone.
  cv::Mat renderRight(int index) const;

 private:
  double time_s(int index) const { return toSeconds(stamps_ns_.at(index)); }
  PixelRays rays(bool right) const;
  Picture look(double time_s, bool right) const;
  Picture exposed(double time_s, bool right) const;
  cv::Mat developed(const cv::Mat& brightness, int index, bool right) const;

  SimulationOptions options_;
  std::optional<UnrectifiedRig> unrectified_;
  std::shared_ptr<const Drive> drive_;
  World world_;
  Traffic traffic_;
  std::vector<std::int64_t> stamps_ns_;
};

}  // namespace rotrocc
