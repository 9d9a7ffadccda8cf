#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include <image_transport/subscriber.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include "bags/recording.h"
#include "input/callback_thread.h"

namespace rotrocc {

/// Where a live recording comes from. The names may be remapped.
struct LiveOptions {
  std::string left_image = "left/image_rect";
  std::string right_image = "right/image_rect";
  std::string image_transport = "raw";
  double baseline_m = 0.0;   ///< in place of that of camera_info; 0: none
  double duration_s = 60.0;  ///< from the first image on
};

/// A stereo recording that comes from the topics of a pair of cameras while it is read, with the
/// times of arrival. It can be read once. camera_info is that of the namespace of each image topic,
/// unless left/camera_info or right/camera_info are remapped, which then name it. Images that come
/// before it are not part of the recording. What is not read in time is left out.
class LiveRecording : public Recording {
 public:
  /// Subscribes at once. Needs a ROS master. Throws std::runtime_error if this machine does not
  /// have the image transport.
  explicit LiveRecording(const LiveOptions& options);
  ~LiveRecording() override;
  LiveRecording(const LiveRecording&) = delete;
  LiveRecording& operator=(const LiveRecording&) = delete;

  std::string description() const override;

  /// The rate is not known before: 30 pairs per second, and after the end what has been read.
  int size() const override;

  /// By the topic's name and the first camera_info. Throws like firstInfos().
  bool isRaw() const override;

  /// When the first camera_info of both cameras had come, and now. Throw like firstInfos().
  ros::Time begin() const override;
  ros::Time end() const override;

  /// Waits for both. Throws std::runtime_error with the topic if one does not come in 10 s, or ROS
  /// shuts down.
  RecordedMessage firstInfos() const override;

  /// Poses and tf are not recorded: the base is the camera, and its path is not known.
  tf2_msgs::TFMessage staticTransforms() const override { return {}; }
  nav_msgs::Path truth() const override { return {}; }
  Eigen::Isometry3d T_base_camera() const override { return Eigen::Isometry3d::Identity(); }

  /// Throws std::runtime_error: there is none.
  GyroRecording gyroscope(const std::string& name) const override;

  /// Does nothing: all is read.
  void select(const ros::Time& from, const ros::Time& to, bool with_tf) override;

  /// Waits for a message. Returns false when the duration is over and all has been read that came
  /// until then, or ROS shuts down, and from then on at once. Throws std::runtime_error with the
  /// topic if no image comes in 10 s.
  bool next(RecordedMessage& message) override;

  std::string leftOut() const override;

 private:
  using Clock = std::chrono::steady_clock;

  /// Of one camera.
  struct Camera {
    image_transport::Subscriber image_subscriber;
    ros::Subscriber info_subscriber;
    sensor_msgs::CameraInfo::ConstPtr first_info;
    std::size_t waiting_images = 0, waiting_infos = 0;  // in messages_
    int left_out = 0;                                   // images
  };

  void subscribe(const std::string& side,
                 const std::string& image_name,
                 Camera& camera,
                 sensor_msgs::Image::ConstPtr RecordedMessage::*image_of,
                 sensor_msgs::CameraInfo::ConstPtr RecordedMessage::*info_of);
  void addInfo(Camera& camera,
               RecordedMessage message,
               const sensor_msgs::CameraInfo::ConstPtr& info);
  void addImage(Camera& camera, RecordedMessage message);
  bool isComplete() const { return left_.first_info && right_.first_info; }
  bool isOver(Clock::time_point now) const;
  void removeFirst(RecordedMessage& message);

  LiveOptions options_;
  CallbackThread callbacks_;
  ros::NodeHandle nh_ = callbacks_.attach(ros::NodeHandle());

  mutable std::mutex mutex_;  // of what follows, up to the subscribers
  mutable std::condition_variable arrival_;
  std::deque<RecordedMessage> messages_;
  std::optional<Clock::time_point> first_image_;
  std::optional<ros::Time> begin_;
  int left_images_read_ = 0;
  bool ended_ = false;

  Camera left_, right_;
};

}  // namespace rotrocc
