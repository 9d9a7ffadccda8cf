#include "player/recording_publisher.h"

#include <geometry_msgs/PoseStamped.h>
#include <ros/console.h>

namespace rotrocc {

RecordingPublisher::RecordingPublisher(ros::NodeHandle& nh,
                                       const Recording& recording,
                                       const std::string& image_topic)
    : recording_(recording),
      truth_(recording.truth()),
      left_image_(nh.advertise<sensor_msgs::Image>("left/" + image_topic, 10)),
      right_image_(nh.advertise<sensor_msgs::Image>("right/" + image_topic, 10)),
      left_info_(nh.advertise<sensor_msgs::CameraInfo>("left/camera_info", 10)),
      right_info_(nh.advertise<sensor_msgs::CameraInfo>("right/camera_info", 10)),
      moving_tf_(nh.advertise<tf2_msgs::TFMessage>("/tf", 10)),
      static_tf_(nh.advertise<tf2_msgs::TFMessage>("/tf_static", 1, true)),
      truth_path_(nh.advertise<nav_msgs::Path>("ground_truth/path", 1, true)),
      truth_pose_(nh.advertise<geometry_msgs::PoseStamped>("ground_truth/pose", 10)) {
  for (const std::string& note : {recording.mountNote(), recording.truthNote()}) {
    if (!note.empty()) ROS_INFO("%s", note.c_str());
  }
}

std::vector<std::string> RecordingPublisher::topicsWithoutSubscriber() const {
  std::vector<std::string> topics;
  for (const ros::Publisher* publisher :
       {&left_image_, &right_image_, &left_info_, &right_info_, &static_tf_}) {
    if (publisher->getNumSubscribers() == 0) topics.push_back(publisher->getTopic());
  }
  return topics;
}

void RecordingPublisher::publishBeginning() {
  static_tf_.publish(recording_.staticTransforms());
  if (!truth_.poses.empty()) truth_path_.publish(truth_);
  publish(recording_.firstInfos());
  next_truth_ = 0;
}

void RecordingPublisher::publish(const RecordedMessage& message) {
  if (message.left_info) left_info_.publish(message.left_info);
  if (message.right_info) right_info_.publish(message.right_info);
  if (message.left_image) left_image_.publish(message.left_image);
  if (message.right_image) right_image_.publish(message.right_image);
  if (message.tf) moving_tf_.publish(message.tf);
}

void RecordingPublisher::publishTruthUntil(const ros::Time& time) {
  for (; next_truth_ < truth_.poses.size(); ++next_truth_) {
    const geometry_msgs::PoseStamped& pose = truth_.poses[next_truth_];
    if (pose.header.stamp > time) return;
    truth_pose_.publish(pose);
  }
}

}  // namespace rotrocc
