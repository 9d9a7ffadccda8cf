#include "player/recording_publisher.h"

#include <geometry_msgs/PoseStamped.h>
#include <ros/console.h>
#include <tf2_msgs/TFMessage.h>

#include "bags/bag_reading.h"

namespace rotrocc {
namespace {

constexpr std::uint32_t kQueueSize = 10;
const char* const kTruthTopic = "/ground_truth/path";

nav_msgs::Path recordedTruth(const rosbag::Bag& bag, const RecordedTf& tf) {
  const auto path = firstMessage<nav_msgs::Path>(bag, kTruthTopic);
  return path ? *path : tf.trajectory();
}

}  // namespace

RecordingPublisher::RecordingPublisher(ros::NodeHandle& nh,
                                       const rosbag::Bag& bag,
                                       const StereoTopics& topics,
                                       const RecordedTf& tf)
    : topics_(topics),
      tf_(tf),
      first_left_info_(firstMessage<sensor_msgs::CameraInfo>(bag, topics.left_info)),
      first_right_info_(firstMessage<sensor_msgs::CameraInfo>(bag, topics.right_info)),
      truth_(recordedTruth(bag, tf)),
      left_image_(nh.advertise<sensor_msgs::Image>("left/image_rect", kQueueSize)),
      right_image_(nh.advertise<sensor_msgs::Image>("right/image_rect", kQueueSize)),
      left_info_(nh.advertise<sensor_msgs::CameraInfo>("left/camera_info", kQueueSize)),
      right_info_(nh.advertise<sensor_msgs::CameraInfo>("right/camera_info", kQueueSize)),
      moving_tf_(nh.advertise<tf2_msgs::TFMessage>("/tf", kQueueSize)),
      static_tf_(nh.advertise<tf2_msgs::TFMessage>("/tf_static", 1, true)),
      truth_path_(nh.advertise<nav_msgs::Path>("ground_truth/path", 1, true)),
      truth_pose_(nh.advertise<geometry_msgs::PoseStamped>("ground_truth/pose", kQueueSize)) {
  if (tf.addedKittiMount()) {
    ROS_INFO("no transform from the base to the camera in the bag: using that of KITTI's car");
  }
  if (!tf.trajectoryName().empty()) {
    ROS_INFO(
        "the bag's tf %s is published as ground truth, not as tf: the odometry publishes the pose "
        "of the base",
        tf.trajectoryName().c_str());
  }
}

std::vector<std::string> RecordingPublisher::recordedTopics() const {
  std::vector<std::string> topics = topics_.all();
  topics.insert(topics.end(), {"/tf", "tf"});
  return topics;
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
  static_tf_.publish(tf_.staticTransforms());
  if (!truth_.poses.empty()) truth_path_.publish(truth_);
  left_info_.publish(first_left_info_);
  right_info_.publish(first_right_info_);
  next_truth_ = 0;
}

void RecordingPublisher::publish(const rosbag::MessageInstance& message) {
  const std::string& topic = message.getTopic();
  if (topic == topics_.left_info) {
    left_info_.publish(readMessage<sensor_msgs::CameraInfo>(message));
  } else if (topic == topics_.right_info) {
    right_info_.publish(readMessage<sensor_msgs::CameraInfo>(message));
  } else {
    const auto transforms = readMessage<tf2_msgs::TFMessage>(message);
    const tf2_msgs::TFMessage kept = tf_.transformsToPlay(*transforms);
    if (!kept.transforms.empty()) moving_tf_.publish(kept);
  }
}

void RecordingPublisher::publishTruthUntil(const ros::Time& time) {
  for (; next_truth_ < truth_.poses.size(); ++next_truth_) {
    const geometry_msgs::PoseStamped& pose = truth_.poses[next_truth_];
    if (pose.header.stamp > time) return;
    truth_pose_.publish(pose);
  }
}

}  // namespace rotrocc
