#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "common/to_seconds.h"
#include "inertial/gyro_sample.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"
#include "rotrocc/trajectory.h"
#include "simulation/drives/scenario.h"
#include "simulation/rendering/gains.h"
#include "simulation/rendering/renderer.h"
#include "simulation/rendering/unrectified_rig.h"
#include "simulation/rendering/worn_rig.h"
#include "simulation/simulation_options.h"

namespace rotrocc {

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

  /// Number of frames, without dropped frames.
  int size() const { return static_cast<int>(stamps_ns_.size()); }

  std::int64_t stamp_ns(int index) const { return stamps_ns_.at(index); }

  /// T_first_left: the pose of the left camera in its first frame.
  Eigen::Isometry3d pose(int index) const;

  /// Measurements of a gyroscope at the left camera, from before the first frame until after the
  /// last one.
  std::vector<GyroSample> gyroscope() const;

  /// Renders both images and the depth of a frame, optionally the flow. Updates the world to this
  /// frame.
  SimulatedFrame render(int index, bool with_flow);

  /// Depths [m] at sub-pixel positions in the left image of a frame; infinite for the sky. Updates
  /// the world to this frame.
  std::vector<double> depthsAt(int index, const std::vector<Eigen::Vector2d>& pixels);

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
  std::vector<Streak> streaks(int index, double exposure_s, bool right) const;
  cv::Mat throughRain(
      const cv::Mat& light, const PixelRays& rays, int index, double exposure_s, bool right) const;
  cv::Mat perfectImage(int index, bool right, Picture sharp);
  cv::Mat wornImage(int index, bool right);
  double gain(int index, bool right) const;
  std::uint64_t noiseKey(int index, bool right) const;
  cv::Mat flowToNext(int index, const Picture& left) const;

  SimulationOptions options_;
  Exposure exposure_;
  Rain rain_;
  double rain_brightness_;
  std::optional<WornRig> worn_;
  std::optional<UnrectifiedRig> unrectified_;
  Gains gains_;
  std::shared_ptr<const Drive> drive_;
  std::unique_ptr<World> world_;
  std::unique_ptr<const Traffic> traffic_;
  std::vector<std::int64_t> stamps_ns_;
};

}  // namespace rotrocc
