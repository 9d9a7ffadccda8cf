#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"
#include "rotrocc/trajectory.h"
#include "simulation/camera_faults.h"
#include "simulation/kitti_camera.h"
#include "simulation/renderer.h"
#include "simulation/scenario.h"

namespace rotrocc {

struct SimulationOptions {
  StereoCamera camera = kittiCamera();
  CameraFaults faults;
  double moving_share = 0.35;  ///< of the places for moving cars that are taken
  double drop_share = 0.0;     ///< of the frames that get lost; never the first
  double rate_hz = 10.0;       ///< of scripted drives; recorded ones have stamps
  double duration_s = 0.0;     ///< frames after that are left out; 0: none
  int frames = 0;              ///< at most; 0: all
  std::uint64_t seed = 1;
  std::uint64_t noise_seed = 1;  ///< of the noise and the exposure jumps of the images
};

/// A stereo pair with its truth for the left image.
struct SimulatedFrame {
  StereoPair pair;
  cv::Mat depth;  ///< CV_64FC1 [m] at the centres of the pixels; infinite for the sky
  cv::Mat flow;   ///< CV_64FC2 [px] to the next frame; NaN where that has it behind the camera;
                 ///< empty for the last frame. Whether something hides the point then is not asked.
};

/// Renders a drive frame by frame, in any order.
class Simulator {
 public:
  /// Throws std::invalid_argument on options out of their range.
  Simulator(const Scenario& scenario, const SimulationOptions& options);

  const StereoCamera& camera() const { return options_.camera; }
  const World& world() const { return *world_; }

  /// Count of frames, without those that got lost.
  int size() const { return static_cast<int>(stamps_ns_.size()); }

  std::int64_t stamp_ns(int index) const { return stamps_ns_.at(index); }

  /// T_first_left: the pose of the left camera in its first frame.
  Eigen::Isometry3d pose(int index) const;

  /// Both images and the depth of a frame, and if asked for the flow. Brings the world to where the
  /// camera then is.
  SimulatedFrame render(int index, bool with_flow);

  /// Depths [m] at places of the left image of a frame, also between its pixels; infinite for the
  /// sky. Brings the world there, too.
  std::vector<double> depthsAt(int index, const std::vector<Eigen::Vector2d>& pixels);

 private:
  double time_s(int index) const { return 1e-9 * static_cast<double>(stamps_ns_.at(index)); }
  Picture look(double time_s, bool right) const;
  cv::Mat brightness(double time_s, bool right) const;
  cv::Mat flowToNext(int index, const Picture& left) const;

  SimulationOptions options_;
  std::shared_ptr<const Drive> drive_;
  std::unique_ptr<World> world_;
  std::unique_ptr<const Traffic> traffic_;
  std::vector<std::int64_t> stamps_ns_;
};

}  // namespace rotrocc
