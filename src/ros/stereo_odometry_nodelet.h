#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>

#include <nodelet/nodelet.h>

#include "base_odometry.h"
#include "camera_mount.h"
#include "latest_mailbox.h"
#include "odometry_messages.h"
#include "odometry_publisher.h"
#include "rotrocc/parameters.h"
#include "rotrocc/trajectory.h"
#include "rotrocc/visual_odometry.h"
#include "stereo_input.h"
#include "stereo_pair_converter.h"
#include "throttle.h"

namespace rotrocc {

/// Live stereo odometry: rectified stereo images in, nav_msgs/Odometry and tf out.
///
/// Subscribes to left/image_rect, right/image_rect (through image_transport), left/camera_info and
/// right/camera_info; tf must lead from base_frame to the frame of the left images. Publishes odom,
/// path, inliers, flow, status and tf. config/default.yaml lists the private parameters.
///
/// The callbacks of the nodelet only make pairs of the images. A thread of its own processes them;
/// if it is too slow it skips to the newest pair.
class StereoOdometryNodelet : public nodelet::Nodelet {
 public:
  ~StereoOdometryNodelet() override;

 private:
  /// Throws std::exception, after a fatal log, on parameters that cannot be used: nothing is
  /// subscribed by then.
  void onInit() override;

  // In the nodelet's thread.
  void start(const Parameters& parameters);

  // In the worker thread.
  void work();
  void processSafely(const ReceivedPair& received, const Eigen::Isometry3d& T_base_camera);
  void process(const ReceivedPair& received, const Eigen::Isometry3d& T_base_camera);
  void restartIfTimeWentBack(std::int64_t stamp_ns);
  InputCounters countInputs() const;
  void logState(const OdometryResult& result);
  void writeTrajectory(const BaseState& state);

  NodeParameters parameters_;
  std::optional<VisualOdometry> odometry_;
  std::optional<BaseOdometry> base_odometry_;  // from the time on when the mount is known
  std::optional<CameraMount> mount_;
  std::optional<OdometryPublisher> publisher_;
  std::optional<TrajectoryWriter> trajectory_;
  StereoPairConverter converter_;

  InputCounters counters_;  // of the worker; countInputs() adds those of the input
  std::optional<std::int64_t> last_stamp_ns_;
  State last_state_ = State::kInitialising;
  Throttle rejected_warning_{std::chrono::seconds(5)};
  Throttle lost_warning_{std::chrono::seconds(5)};

  LatestMailbox<ReceivedPair> mailbox_;
  std::optional<StereoInput> input_;
  std::thread worker_;
};

}  // namespace rotrocc
