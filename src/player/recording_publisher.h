#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nav_msgs/Path.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "bags/recording.h"

namespace rotrocc {

/// Publishes a recording to {left,right}/image_rect or image_raw, {left,right}/camera_info, /tf,
/// /tf_static, ground_truth/path and ground_truth/pose.
class RecordingPublisher {
 public:
  /// `image_topic`: image_rect, or image_raw if the odometry rectifies. `recording` must outlive
  /// this object. Logs its notes.
  RecordingPublisher(ros::NodeHandle& nh,
                     const Recording& recording,
                     const std::string& image_topic);

  const nav_msgs::Path& truth() const { return truth_; }

  /// Topics that an odometry needs but that have no subscriber.
  std::vector<std::string> topicsWithoutSubscriber() const;

  /// Static transforms and the true path, both latched, and the first camera_infos.
  void publishBeginning();

  void publish(const RecordedMessage& message);

  /// Publishes the remaining true poses up to `time`.
  void publishTruthUntil(const ros::Time& time);

 private:
  const Recording& recording_;
  const nav_msgs::Path truth_;
  std::size_t next_truth_ = 0;

  ros::Publisher left_image_;
  ros::Publisher right_image_;
  ros::Publisher left_info_;
  ros::Publisher right_info_;
  ros::Publisher moving_tf_;
  ros::Publisher static_tf_;
  ros::Publisher truth_path_;
  ros::Publisher truth_pose_;
};

}  // namespace rotrocc
