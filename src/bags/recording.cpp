#include "bags/recording.h"

#include <filesystem>
#include <optional>
#include <stdexcept>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>
#include <tf2_eigen/tf2_eigen.h>
#include <boost/make_shared.hpp>

#include "bags/bag_reading.h"
#include "bags/recorded_tf.h"
#include "bags/sequence_recording.h"
#include "bags/stereo_topics.h"
#include "input/camera_calibration.h"
#include "input/message_conversion.h"

namespace rotrocc {
namespace {

/// Throws std::runtime_error if there is none.
template <typename Message>
boost::shared_ptr<Message> requireFirst(const rosbag::Bag& bag, const std::string& topic) {
  const auto message = firstMessage<Message>(bag, topic);
  if (!message) throw std::runtime_error("the bag has no messages of " + topic);
  return message;
}

class BagRecording : public Recording {
 public:
  BagRecording(const std::string& path, const RecordingOptions& options)
      : path_(path),
        bag_(openBag(path)),
        base_frame_(options.base_frame),
        topics_(findStereoTopics(topicTypes(bag_), options.left_image, options.right_image)),
        camera_frame_(requireFirst<sensor_msgs::Image>(bag_, topics_.left_image)->header.frame_id),
        first_left_info_(requireFirst<sensor_msgs::CameraInfo>(bag_, topics_.left_info)),
        first_right_info_(requireFirst<sensor_msgs::CameraInfo>(bag_, topics_.right_info)) {
    rosbag::View view(bag_, rosbag::TopicQuery(topics_.all()));
    begin_ = view.getBeginTime();
    end_ = view.getEndTime();
  }

  std::string description() const override {
    return topics_.left_image + " and " + topics_.right_image + " of " + path_;
  }

  int size() const override {
    rosbag::View view(bag_, rosbag::TopicQuery(topics_.left_image));
    return static_cast<int>(view.size());
  }

  /// Whether a topic is not one of rectified images, and the first camera_info describes raw ones.
  bool isRaw() const override {
    if (isRectifiedByName(topics_.left_image)) return false;
    return describesRawImages(*first_left_info_) || describesRawImages(*first_right_info_);
  }

  std::vector<std::string> notes() const override {
    std::vector<std::string> notes;
    if (tf().added_kitti_mount) {
      notes.push_back(
          "no transform from the base to the camera in the bag: using that of KITTI's car");
    }
    if (!tf().trajectory_name.empty()) {
      notes.push_back("the bag's tf " + tf().trajectory_name +
                      " is published as ground truth, not as tf: the odometry publishes the pose "
                      "of the base");
    }
    return notes;
  }

  ros::Time begin() const override { return begin_; }
  ros::Time end() const override { return end_; }
  sensor_msgs::CameraInfo::ConstPtr firstLeftInfo() const override { return first_left_info_; }
  sensor_msgs::CameraInfo::ConstPtr firstRightInfo() const override { return first_right_info_; }
  tf2_msgs::TFMessage staticTransforms() const override { return tf().static_transforms; }
  Eigen::Isometry3d T_base_camera() const override { return tf().T_base_camera; }

  nav_msgs::Path truth() const override {
    const auto path = firstMessage<nav_msgs::Path>(bag_, "/ground_truth/path");
    return path ? *path : tf().trajectory;
  }

  GyroRecording gyroscope(const std::string& topic) const override {
    GyroRecording recording;
    std::string frame;
    for (const rosbag::MessageInstance& instance : rosbag::View(bag_, rosbag::TopicQuery(topic))) {
      const auto message = readMessage<sensor_msgs::Imu>(instance);
      frame = message->header.frame_id;
      recording.samples.push_back(toGyroSample(*message));
    }
    if (recording.samples.empty()) {
      throw std::runtime_error("there is neither a file nor a topic " + topic +
                               " with a gyroscope");
    }
    const RecordedTf tf_of_gyroscope = readTf(bag_, base_frame_, frame);
    if (tf_of_gyroscope.added_kitti_mount) {
      throw std::runtime_error("the bag has no tf from " + base_frame_ + " to '" + frame +
                               "', the frame of " + topic);
    }
    recording.R_camera_gyro =
        T_base_camera().linear().transpose() * tf_of_gyroscope.T_base_camera.linear();
    return recording;
  }

  void select(const ros::Time& from, const ros::Time& to, bool with_tf) override {
    std::vector<std::string> topics = topics_.all();
    if (with_tf) topics.insert(topics.end(), {"/tf", "tf"});
    selected_.emplace(bag_, rosbag::TopicQuery(topics), from, to);
    next_ = selected_->begin();
  }

  bool next(RecordedMessage& message) override {
    while (next_ != selected_->end()) {
      const rosbag::MessageInstance instance = *next_;
      ++next_;
      if (read(instance, message)) return true;
    }
    return false;
  }

 private:
  const RecordedTf& tf() const {
    if (!tf_) tf_ = readTf(bag_, base_frame_, camera_frame_);
    return *tf_;
  }

  /// Returns false if nothing is left of it.
  bool read(const rosbag::MessageInstance& instance, RecordedMessage& message) const {
    message = {};
    message.time = instance.getTime();
    const std::string& topic = instance.getTopic();
    if (topic == topics_.left_image) {
      message.left_image = readMessage<sensor_msgs::Image>(instance);
    } else if (topic == topics_.right_image) {
      message.right_image = readMessage<sensor_msgs::Image>(instance);
    } else if (topic == topics_.left_info) {
      message.left_info = readMessage<sensor_msgs::CameraInfo>(instance);
    } else if (topic == topics_.right_info) {
      message.right_info = readMessage<sensor_msgs::CameraInfo>(instance);
    } else {
      const auto recorded = readMessage<tf2_msgs::TFMessage>(instance);
      const auto kept = boost::make_shared<tf2_msgs::TFMessage>(tf().transformsToPlay(*recorded));
      if (kept->transforms.empty()) return false;
      message.tf = kept;
    }
    return true;
  }

  std::string path_;
  rosbag::Bag bag_;
  std::string base_frame_;
  StereoTopics topics_;
  std::string camera_frame_;
  mutable std::optional<RecordedTf> tf_;  // read when it is needed: there may be much of it
  sensor_msgs::CameraInfo::ConstPtr first_left_info_;
  sensor_msgs::CameraInfo::ConstPtr first_right_info_;
  ros::Time begin_;
  ros::Time end_;
  std::optional<rosbag::View> selected_;
  rosbag::View::iterator next_;
};

}  // namespace

std::unique_ptr<Recording> openRecording(const std::string& path, const RecordingOptions& options) {
  if (!std::filesystem::is_directory(path)) {
    return std::make_unique<BagRecording>(path, options);
  }
  return std::make_unique<SequenceRecording>(
      path, SequenceRecording::Options{std::nullopt, true, options.sequence});
}

nav_msgs::Path pathOfBase(const Trajectory& recorded, const Eigen::Isometry3d& T_base_body) {
  nav_msgs::Path path;
  path.header.frame_id = "odom";
  if (recorded.empty()) return path;

  const Eigen::Isometry3d T_first_world = recorded.front().T_world_body.inverse();
  for (const StampedPose& pose : recorded) {
    const Eigen::Isometry3d T_first_body = T_first_world * pose.T_world_body;
    geometry_msgs::PoseStamped message;
    message.header.frame_id = path.header.frame_id;
    message.header.stamp = toRosTime(pose.stamp_ns);
    message.pose = tf2::toMsg(T_base_body * T_first_body * T_base_body.inverse());
    path.poses.push_back(message);
  }
  path.header.stamp = path.poses.front().header.stamp;
  return path;
}

}  // namespace rotrocc
