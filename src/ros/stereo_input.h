#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include <image_transport/image_transport.h>
#include <image_transport/subscriber.h>
#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>

#include "rotrocc/parameters.h"
#include "rotrocc/stereo_camera.h"
#include "stereo_synchronizer.h"
#include "throttle.h"

namespace rotrocc {

/// A pair as it was received, with the camera that was known at that time.
struct ReceivedPair {
  StereoImages images;
  StereoCamera camera;
  std::chrono::steady_clock::time_point arrival;
};

/// Subscribes to left/image_rect, left/camera_info, right/image_rect and right/camera_info, and
/// makes pairs of them. Its callbacks must not run at the same time: take a handle of one queue and
/// thread.
class StereoInput {
 public:
  using PairHandler = std::function<void(ReceivedPair)>;

  /// Hands each pair to `on_pair` as soon as it is complete. The latest one waits while there is no
  /// valid camera_info.
  StereoInput(ros::NodeHandle& nh, const NodeParameters& parameters, PairHandler on_pair);

  /// These two may be called from any thread.
  std::uint64_t unmatchedImages() const { return unmatched_images_; }
  /// Camera_infos that are not valid, and pairs that came when there was none.
  std::uint64_t rejected() const { return rejected_; }

 private:
  void onLeftImage(const sensor_msgs::Image::ConstPtr& image);
  void onRightImage(const sensor_msgs::Image::ConstPtr& image);
  void onLeftInfo(const sensor_msgs::CameraInfo::ConstPtr& info);
  void onRightInfo(const sensor_msgs::CameraInfo::ConstPtr& info);
  void takePair(const std::optional<StereoImages>& images);
  void updateCamera();
  void setCamera(const StereoCamera& camera);
  void handOver();
  std::string missingInfo() const;

  PairHandler on_pair_;
  StereoSynchronizer synchronizer_;
  std::optional<ReceivedPair> waiting_;

  sensor_msgs::CameraInfo::ConstPtr left_info_;
  sensor_msgs::CameraInfo::ConstPtr right_info_;
  std::optional<StereoCamera> camera_;
  std::string camera_error_;
  Throttle warning_{std::chrono::seconds(5)};

  std::atomic<std::uint64_t> unmatched_images_{0};
  std::atomic<std::uint64_t> rejected_{0};

  // Last, so that no callback comes when the rest is gone.
  image_transport::Subscriber left_image_subscriber_;
  image_transport::Subscriber right_image_subscriber_;
  ros::Subscriber left_info_subscriber_;
  ros::Subscriber right_info_subscriber_;
};

}  // namespace rotrocc
