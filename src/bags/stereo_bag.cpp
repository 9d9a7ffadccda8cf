#include "bags/stereo_bag.h"

#include <optional>
#include <stdexcept>

#include "bags/bag_reading.h"
#include "input/camera_validation.h"
#include "input/to_text.h"
#include "sequences/camera_info_calibration.h"

namespace rotrocc {
namespace {

int countMessages(const rosbag::Bag& bag, const std::string& topic) {
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  return static_cast<int>(view.size());
}

/// Whether two messages describe the same camera.
bool isSameCamera(const sensor_msgs::CameraInfo& a, const sensor_msgs::CameraInfo& b) {
  return a.width == b.width && a.height == b.height && a.distortion_model == b.distortion_model &&
         a.D == b.D && a.K == b.K && a.R == b.R && a.P == b.P && a.binning_x == b.binning_x &&
         a.binning_y == b.binning_y && a.roi == b.roi;
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
      rectifies_(shallRectify(options.rectify)) {}

bool StereoBag::shallRectify(Rectify rectify) const {
  if (rectify != Rectify::kIfRaw) return rectify == Rectify::kAlways;
  if (isRectifiedByName(topics_.left_image)) return false;
  return (left_info_ && describesRawImages(*left_info_)) ||
         (right_info_ && describesRawImages(*right_info_));
}

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
  pair = rectifies_ ? rectify(converted) : converted;
  camera = current;
}

StereoPair StereoBag::rectify(const StereoPair& raw) {
  // The maps take longer than a pair, and cameras hardly ever change.
  const bool is_current = rectifier_ && isSameCamera(*left_info_, *rectifier_left_info_) &&
                          isSameCamera(*right_info_, *rectifier_right_info_);
  if (!is_current) {
    rectifier_ = std::make_unique<StereoRectifier>(
        toStereoCalibration(*left_info_, *right_info_, baseline_m_));
    rectifier_left_info_ = left_info_;
    rectifier_right_info_ = right_info_;
  }
  return rectifier_->rectify(raw);
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
