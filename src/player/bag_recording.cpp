#include "player/bag_recording.h"

#include <stdexcept>

#include <boost/make_shared.hpp>

#include "bags/bag_reading.h"
#include "bags/stereo_bag.h"

namespace rotrocc {
namespace {

const char* const kTruthTopic = "/ground_truth/path";

std::string cameraFrame(const rosbag::Bag& bag, const StereoTopics& topics) {
  return firstMessage<sensor_msgs::Image>(bag, topics.left_image)->header.frame_id;
}

/// Topics that an odometry can use: rectified images, or raw ones if it rectifies.
StereoTopics usableTopics(const rosbag::Bag& bag, const PlayerOptions& options) {
  const StereoTopics topics =
      findStereoTopics(topicTypes(bag), options.left_image, options.right_image);
  if (!options.rectify && hasRawImages(bag, topics)) {
    throw std::invalid_argument("the images of " + topics.left_image +
                                " are not rectified: start with rectify:=true");
  }
  return topics;
}

nav_msgs::Path recordedTruth(const rosbag::Bag& bag, const RecordedTf& tf) {
  const auto path = firstMessage<nav_msgs::Path>(bag, kTruthTopic);
  return path ? *path : tf.trajectory();
}

}  // namespace

BagRecording::BagRecording(const PlayerOptions& options)
    : path_(options.bag),
      bag_(openBag(options.bag)),
      topics_(usableTopics(bag_, options)),
      image_topic_(options.rectify ? "image_raw" : "image_rect"),
      tf_(bag_, options.base_frame, cameraFrame(bag_, topics_)),
      truth_(recordedTruth(bag_, tf_)),
      first_left_info_(firstMessage<sensor_msgs::CameraInfo>(bag_, topics_.left_info)),
      first_right_info_(firstMessage<sensor_msgs::CameraInfo>(bag_, topics_.right_info)) {
  rosbag::View view(bag_, rosbag::TopicQuery(topics_.all()));
  begin_ = view.getBeginTime();
  end_ = view.getEndTime();
}

std::string BagRecording::description() const {
  return topics_.left_image + " and " + topics_.right_image + " of " + path_;
}

std::vector<std::string> BagRecording::notes() const {
  std::vector<std::string> notes;
  if (tf_.addedKittiMount()) {
    notes.push_back(
        "no transform from the base to the camera in the bag: using that of KITTI's car");
  }
  if (!tf_.trajectoryName().empty()) {
    notes.push_back("the bag's tf " + tf_.trajectoryName() +
                    " is published as ground truth, not as tf: the odometry publishes the pose of "
                    "the base");
  }
  return notes;
}

void BagRecording::select(const ros::Time& from, const ros::Time& to) {
  std::vector<std::string> topics = topics_.all();
  topics.insert(topics.end(), {"/tf", "tf"});
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
    const auto kept = boost::make_shared<tf2_msgs::TFMessage>(tf_.transformsToPlay(*recorded));
    if (kept->transforms.empty()) return false;
    message.tf = kept;
  }
  return true;
}

}  // namespace rotrocc
