#include "bags/stereo_bag.h"

#include <optional>
#include <stdexcept>

#include "bags/bag_reading.h"
#include "input/camera_validation.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

int countMessages(const rosbag::Bag& bag, const std::string& topic) {
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  return static_cast<int>(view.size());
}

}  // namespace

StereoBag::StereoBag(const rosbag::Bag& bag, const Options& options)
    : topics_(findStereoTopics(topicTypes(bag), options.left_image, options.right_image)),
      size_(countMessages(bag, topics_.left_image)),
      view_(bag, rosbag::TopicQuery(topics_.all())),
      next_(view_.begin()),
      synchronizer_(options.max_stamp_difference_s, options.queue_size),
      converter_(options.max_image_pixels),
      baseline_m_(options.baseline_m),
      left_info_(firstMessage<sensor_msgs::CameraInfo>(bag, topics_.left_info)),
      right_info_(firstMessage<sensor_msgs::CameraInfo>(bag, topics_.right_info)) {}

bool StereoBag::next(StereoPair& pair, StereoCamera& camera) {
  bool complete = false;
  for (; !complete && next_ != view_.end(); ++next_) complete = read(*next_);
  if (!complete) return false;
  try {
    const StereoCamera current = toStereoCamera(*left_info_, *right_info_, baseline_m_);
    pair = converter_.convert(*images_.left, *images_.right);
    camera = current;
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error("pair of " + toText(images_.left->header.stamp) +
                             " s: " + error.what());
  }
  return true;
}

bool StereoBag::read(const rosbag::MessageInstance& message) {
  const std::string& topic = message.getTopic();
  std::optional<StereoImages> images;
  if (topic == topics_.left_image) {
    images = synchronizer_.addLeft(readMessage<sensor_msgs::Image>(message));
  } else if (topic == topics_.right_image) {
    images = synchronizer_.addRight(readMessage<sensor_msgs::Image>(message));
  } else if (topic == topics_.left_info) {
    left_info_ = readMessage<sensor_msgs::CameraInfo>(message);
  } else {
    right_info_ = readMessage<sensor_msgs::CameraInfo>(message);
  }
  if (images) images_ = *images;
  return images.has_value();
}

StereoBag::Options bagOptions(const NodeParameters& node) {
  StereoBag::Options options;
  options.max_stamp_difference_s = node.max_stamp_difference_s;
  options.queue_size = node.queue_size;
  options.max_image_pixels = node.max_image_pixels;
  options.baseline_m = node.baseline_m;
  return options;
}

}  // namespace rotrocc
