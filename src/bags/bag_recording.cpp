#include "bags/bag_recording.h"

#include <stdexcept>

#include <sensor_msgs/Imu.h>
#include <boost/make_shared.hpp>

#include "bags/bag_reading.h"
#include "input/camera_calibration.h"
#include "input/message_conversion.h"

namespace rotrocc {
namespace {

const char* const kTruthTopic = "/ground_truth/path";

/// Throws std::runtime_error if there is none.
template <typename Message>
boost::shared_ptr<Message> requireFirst(const rosbag::Bag& bag, const std::string& topic) {
  const auto message = firstMessage<Message>(bag, topic);
  if (!message) throw std::runtime_error("the bag has no messages of " + topic);
  return message;
}

}  // namespace

BagRecording::BagRecording(const std::string& path, const RecordingOptions& options)
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

std::string BagRecording::description() const {
  return topics_.left_image + " and " + topics_.right_image + " of " + path_;
}

int BagRecording::size() const {
  rosbag::View view(bag_, rosbag::TopicQuery(topics_.left_image));
  return static_cast<int>(view.size());
}

bool BagRecording::isRaw() const {
  if (isRectifiedByName(topics_.left_image)) return false;
  return describesRawImages(*first_left_info_) || describesRawImages(*first_right_info_);
}

std::vector<std::string> BagRecording::notes() const {
  std::vector<std::string> notes;
  if (tf().addedKittiMount()) {
    notes.push_back(
        "no transform from the base to the camera in the bag: using that of KITTI's car");
  }
  if (!tf().trajectoryName().empty()) {
    notes.push_back("the bag's tf " + tf().trajectoryName() +
                    " is published as ground truth, not as tf: the odometry publishes the pose of "
                    "the base");
  }
  return notes;
}

nav_msgs::Path BagRecording::truth() const {
  const auto path = firstMessage<nav_msgs::Path>(bag_, kTruthTopic);
  return path ? *path : tf().trajectory();
}

GyroRecording BagRecording::gyroscope(const std::string& topic) const {
  GyroRecording recording;
  std::string frame;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag_, rosbag::TopicQuery(topic))) {
    const auto message = readMessage<sensor_msgs::Imu>(instance);
    frame = message->header.frame_id;
    recording.samples.push_back(toGyroSample(*message));
  }
  if (recording.samples.empty()) {
    throw std::runtime_error("there is neither a file nor a topic " + topic + " with a gyroscope");
  }
  const RecordedTf tf_of_gyroscope(bag_, base_frame_, frame);
  if (tf_of_gyroscope.addedKittiMount()) {
    throw std::runtime_error("the bag has no tf from " + base_frame_ + " to '" + frame +
                             "', the frame of " + topic);
  }
  recording.R_camera_gyro =
      T_base_camera().linear().transpose() * tf_of_gyroscope.T_base_camera().linear();
  return recording;
}

void BagRecording::select(const ros::Time& from, const ros::Time& to, bool with_tf) {
  std::vector<std::string> topics = topics_.all();
  if (with_tf) topics.insert(topics.end(), {"/tf", "tf"});
  selected_.emplace(bag_, rosbag::TopicQuery(topics), from, to);
  next_ = selected_->begin();
}

bool BagRecording::next(RecordedMessage& message) {
  while (next_ != selected_->end()) {
    const rosbag::MessageInstance instance = *next_;
    ++next_;
    if (read(instance, message)) return true;
  }
  return false;
}

const RecordedTf& BagRecording::tf() const {
  if (!tf_) tf_.emplace(bag_, base_frame_, camera_frame_);
  return *tf_;
}

/// Returns false if nothing is left of it.
bool BagRecording::read(const rosbag::MessageInstance& instance, RecordedMessage& message) const {
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

}  // namespace rotrocc
