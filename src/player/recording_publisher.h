#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nav_msgs/Path.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <rosbag/bag.h>
#include <rosbag/message_instance.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "bags/recorded_tf.h"
#include "bags/stereo_topics.h"

namespace rotrocc {

/// Publishes a stereo bag, whatever its topics are, to {left,right}/image_rect,
/// {left,right}/camera_info, /tf, /tf_static, ground_truth/path and ground_truth/pose.
class RecordingPublisher {
 public:
  /// Advertises the topics. `tf` must outlive this object. Logs how recorded poses are used.
  RecordingPublisher(ros::NodeHandle& nh,
                     const rosbag::Bag& bag,
                     const StereoTopics& topics,
                     const RecordedTf& tf);

  /// Topics of the bag for publish().
  std::vector<std::string> recordedTopics() const;

  /// True path of the base in the frame odom; empty if the bag has none.
  const nav_msgs::Path& truth() const { return truth_; }

  /// Topics that an odometry needs but that have no subscriber.
  std::vector<std::string> topicsWithoutSubscriber() const;

  /// Publishes what is needed before the first image: static transforms, the true path (both
  /// latched) and the first camera_infos.
  void publishBeginning();

  void publishLeft(const sensor_msgs::Image::ConstPtr& image) { left_image_.publish(image); }
  void publishRight(const sensor_msgs::Image::ConstPtr& image) { right_image_.publish(image); }

  /// Publishes a message of the bag other than an image.
  void publish(const rosbag::MessageInstance& message);

  /// Publishes the remaining true poses up to `time`.
  void publishTruthUntil(const ros::Time& time);

 private:
  StereoTopics topics_;
  const RecordedTf& tf_;
  sensor_msgs::CameraInfo::ConstPtr first_left_info_;
  sensor_msgs::CameraInfo::ConstPtr first_right_info_;
  nav_msgs::Path truth_;
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
