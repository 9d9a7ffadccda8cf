#include "bags/stereo_bag.h"

#include <optional>
#include <stdexcept>

#include "bags/bag_reading.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

int countMessages(const rosbag::Bag& bag, const std::string& topic) {
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  return static_cast<int>(view.size());
}

bool shallRectify(StereoBag::Rectify rectify, const rosbag::Bag& bag, const StereoTopics& topics) {
  if (rectify == StereoBag::Rectify::kIfRaw) return hasRawImages(bag, topics);
  return rectify == StereoBag::Rectify::kAlways;
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
      right_info_(firstMessage<sensor_msgs::CameraInfo>(bag, topics_.right_info)),
      rectifies_(shallRectify(options.rectify, bag, topics_)),
      calibration_(options.baseline_m) {}

bool StereoBag::next(StereoPair& pair, StereoCamera& camera) {
  bool complete = false;
  for (; !complete && next_ != view_.end(); ++next_) complete = read(*next_);
  if (!complete) return false;
  try {
    convert(pair, camera);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error("pair of " + toText(images_.left->header.stamp) +
                             " s: " + error.what());
  }
  return true;
}

void StereoBag::convert(StereoPair& pair, StereoCamera& camera) {
  const StereoCamera current = toStereoCamera(*left_info_, *right_info_, baseline_m_);
  const StereoPair converted = converter_.convert(*images_.left, *images_.right);
  if (rectifies_) validateSize(*images_.left, current);
  pair = rectifies_ ? rectifier_.rectify(converted, calibration_.of(left_info_, right_info_))
                    : converted;
  camera = current;
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

bool hasRawImages(const rosbag::Bag& bag, const StereoTopics& topics) {
  if (isRectifiedByName(topics.left_image)) return false;
  const auto isOfRawImages = [&](const std::string& info_topic) {
    const auto info = firstMessage<sensor_msgs::CameraInfo>(bag, info_topic);
    return info && describesRawImages(*info);
  };
  return isOfRawImages(topics.left_info) || isOfRawImages(topics.right_info);
}

StereoBag::Rectify rectifyOption(const std::string& text) {
  if (text == "auto") return StereoBag::Rectify::kIfRaw;
  if (text == "yes") return StereoBag::Rectify::kAlways;
  if (text == "no") return StereoBag::Rectify::kNever;
  throw std::invalid_argument("--rectify is '" + text + "', not auto, yes or no");
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
