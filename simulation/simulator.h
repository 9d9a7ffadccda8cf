#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "common/to_seconds.h"
#include "geometry/kitti_camera.h"
#include "inertial/gyro_sample.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"
#include "rotrocc/trajectory.h"
#include "simulation/drives/scenario.h"
#include "simulation/rendering/renderer.h"
#include "simulation/rendering/sensor.h"
#include "simulation/rendering/unrectified_rig.h"
#include "simulation/rendering/worn_rig.h"
#include "simulation/stress/lorry.h"

namespace rotrocc {

/// Faults of a stereo rig that are not in its calibration file.
struct CameraFaults {
  double disparity_bias_px = 0.0;                                ///< added to all disparities
  Eigen::Vector3d right_rotation_rad = Eigen::Vector3d::Zero();  ///< of the right camera: about its
                                                                 ///< z (roll), x (pitch), y (yaw)
  double row_offset_px = 0.0;      ///< of the right image: what it shows is this much lower
  double right_focal_ratio = 1.0;  ///< focal length of the right camera, over the nominal one
  double time_skew_s = 0.0;        ///< delay of the right camera
  double motion_blur_s = 0.0;      ///< exposure time, around the stamp
  Sensor sensor;

  /// Throws std::invalid_argument, naming the first value out of range.
  void check() const;

  /// True T_left_right of the rig.
  Eigen::Isometry3d rightCamera(const StereoCamera& camera) const;
};

struct SimulationOptions {
  StereoCamera camera = kittiCamera();
  /// Cameras with the remainders of calibration, sensors, wind and reflections of the real world,
  /// by the seed. They have motion blur and noise of their own: those of `faults` are not used.
  bool worn_rig = false;
  /// Lens of cameras whose images are not rectified, without worn_rig: radtan or equidistant;
  /// empty: none.
  std::string lens;
  CameraFaults faults;
  double moving_share = 0.35;  ///< occupied share of the places for moving cars
  LorryPlan lorry;
  double tiled_share = 0.0;  ///< share of all textures that is the same tile everywhere
  double rate_hz = 10.0;     ///< of scripted drives; recorded ones have stamps
  int frames = 0;            ///< largest number of frames; 0: all
  std::uint64_t seed = 1;
  std::uint64_t noise_seed = 1;  ///< of the noise of the images

  /// Throws std::invalid_argument on options out of range.
  void check() const;
};

/// A stereo pair with ground truth for the left image.
struct SimulatedFrame {
  StereoPair pair;
  cv::Mat depth;  ///< CV_64FC1 [m] at the centres of the pixels; infinite for the sky; of a worn
                  ///< rig that of the nominal camera, and empty without flow
  cv::Mat flow;   ///< CV_64FC2 [px] to the next frame; NaN for points that are behind the camera
                  ///< there; empty for the last frame. Occlusion is ignored.
};

/// Renders a drive frame by frame, in any order.
class Simulator {
 public:
  /// Throws std::invalid_argument on options out of range.
  Simulator(const Scenario& scenario, const SimulationOptions& options);

  const StereoCamera& camera() const { return options_.camera; }
  const World& world() const { return *world_; }

  /// Set if the options have a lens.
  const std::optional<UnrectifiedRig>& unrectifiedRig() const { return unrectified_; }

  int size() const { return static_cast<int>(stamps_ns_.size()); }

  std::int64_t stamp_ns(int index) const { return stamps_ns_.at(index); }

  /// T_first_left: the pose of the left camera in its first frame.
  Eigen::Isometry3d pose(int index) const;

  /// Measurements of a gyroscope at the left camera, from before the first frame until after the
  /// last one.
  std::vector<GyroSample> gyroscope() const;

  /// Renders both images and the depth of a frame, optionally the flow.
  SimulatedFrame render(int index, bool with_flow);

 private:
  double time_s(int index) const { return toSeconds(stamps_ns_.at(index)); }
  PixelRays rays(bool right) const;
  Eigen::Isometry3d cameraPose(double time_s, bool right) const;
  Picture look(double time_s, bool right, const PixelRays& rays);
  SeenMotions motions(double from_s, double to_s, bool right) const;
  double exposedAt(int index, bool right) const;
  cv::Mat meanLight(double time_s, const PixelRays& rays, bool right);
  cv::Mat smearedLight(const Picture& picture,
                       double time_s,
                       double exposure_s,
                       const PixelRays& rays,
                       bool right) const;
  cv::Mat perfectImage(int index, bool right, Picture sharp);
  cv::Mat wornImage(int index, bool right);
  std::uint64_t noiseKey(int index, bool right) const;
  cv::Mat flowToNext(int index, const Picture& left) const;

  SimulationOptions options_;
  Exposure exposure_;
  std::optional<WornRig> worn_;
  std::optional<UnrectifiedRig> unrectified_;
  std::shared_ptr<const Drive> drive_;
  std::unique_ptr<World> world_;
  std::unique_ptr<const Traffic> traffic_;
  std::vector<std::int64_t> stamps_ns_;
};

}  // namespace rotrocc
