#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "input/drop_log.h"
#include "input/input_report.h"
#include "input/stamp_guard.h"
#include "input/stereo_synchronizer.h"
#include "input/topic_statistics.h"
#include "rotrocc/parameters.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// A pair as it was received, with the camera that was known at that time.
struct ReceivedPair {
  StereoImages images;
  StereoCamera camera;
  std::chrono::steady_clock::time_point arrival;
};

/// When a message came: by the steady clock, and in ROS time, 0 if that is not known.
struct Arrival {
  std::chrono::steady_clock::time_point time;
  std::int64_t clock_ns = 0;
};

/// Makes pairs of four streams of messages, and keeps account of them. Knows no topics and takes no
/// part in ROS; not for several threads at once.
class StereoIntake {
 public:
  using PairHandler = std::function<void(ReceivedPair)>;

  /// One of the two cameras.
  enum class Side { kLeft, kRight };

  /// Hands each pair to `on_pair` as soon as it is complete. The latest one waits while there is no
  /// valid camera_info. `drops` must outlive this.
  StereoIntake(const NodeParameters& parameters, DropLog& drops, PairHandler on_pair);

  /// Never throw: what cannot be used goes to the log of drops.
  void addImage(Side side, const sensor_msgs::Image::ConstPtr& image, const Arrival& arrival);
  void addInfo(Side side, const sensor_msgs::CameraInfo::ConstPtr& info, const Arrival& arrival);

  /// What came lately. Names and publishers of topics, and the clock, are left to those who know.
  InputReport report(std::chrono::steady_clock::time_point now) const;

 private:
  void takePair(const std::optional<StereoImages>& images, const Arrival& arrival);
  void updateCamera();
  void setCamera(const StereoCamera& camera);
  void handOver();

  NodeParameters parameters_;
  DropLog& drops_;
  PairHandler on_pair_;

  StampGuard left_guard_, right_guard_;
  StereoSynchronizer synchronizer_;
  std::optional<ReceivedPair> waiting_;

  sensor_msgs::CameraInfo::ConstPtr left_info_, right_info_;
  std::optional<StereoCamera> camera_;
  std::string camera_error_;

  TopicStatistics left_images_, right_images_, left_infos_, right_infos_, pairs_;
};

}  // namespace rotrocc
