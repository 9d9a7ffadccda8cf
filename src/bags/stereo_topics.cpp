#include "bags/stereo_topics.h"

#include <stdexcept>
#include <vector>

#include <rosbag/view.h>

namespace rotrocc {
namespace {

const char* const kImageType = "sensor_msgs/Image";
const char* const kInfoType = "sensor_msgs/CameraInfo";

bool hasTopic(const TopicTypes& types, const std::string& topic, const std::string& type) {
  const auto found = types.find(topic);
  return found != types.end() && found->second == type;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The camera_info topic of an image topic.
std::string infoOf(const std::string& image) {
  return image.substr(0, image.rfind('/') + 1) + "camera_info";
}

StereoTopics withInfos(const std::string& left_image, const std::string& right_image) {
  return {left_image, right_image, infoOf(left_image), infoOf(right_image)};
}

/// The name with its last "left" replaced by "right"; empty if it has none.
std::string rightOf(const std::string& left_image) {
  const std::string left = "left";
  const std::size_t position = left_image.rfind(left);
  if (position == std::string::npos) return "";
  return std::string(left_image).replace(position, left.size(), "right");
}

/// Lower is better.
int rank(const StereoTopics& topics) {
  const bool rectified = contains(topics.left_image, "rect");
  const bool colour = contains(topics.left_image, "color");
  return (rectified ? 0 : 2) + (colour ? 1 : 0);
}

std::string imageTopics(const TopicTypes& types) {
  std::string list;
  for (const auto& [topic, type] : types) {
    if (type == kImageType) list += "\n  " + topic;
  }
  return list.empty() ? " none" : list;
}

StereoTopics namedTopics(const TopicTypes& types,
                         const std::string& left_image,
                         const std::string& right_image) {
  const StereoTopics topics = withInfos(left_image, right_image);
  for (const std::string& image : {topics.left_image, topics.right_image}) {
    if (hasTopic(types, image, kImageType)) continue;
    throw std::runtime_error("no topic '" + image + "' of type " + kImageType +
                             ", image topics:" + imageTopics(types));
  }
  for (const std::string& info : {topics.left_info, topics.right_info}) {
    if (hasTopic(types, info, kInfoType)) continue;
    throw std::runtime_error("no topic '" + info + "' of type " + kInfoType +
                             ", which is required with the images");
  }
  return topics;
}

}  // namespace

TopicTypes topicTypes(const rosbag::Bag& bag) {
  TopicTypes types;
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    types[connection->topic] = connection->datatype;
  }
  return types;
}

StereoTopics findStereoTopics(const TopicTypes& types,
                              const std::string& left_image,
                              const std::string& right_image) {
  if (left_image.empty() != right_image.empty()) {
    throw std::runtime_error("specify both the left and the right image topic, or none");
  }
  if (!left_image.empty()) return namedTopics(types, left_image, right_image);

  std::vector<StereoTopics> best;
  for (const auto& [topic, type] : types) {
    const StereoTopics topics = withInfos(topic, rightOf(topic));
    if (!hasTopic(types, topics.left_image, kImageType) ||
        !hasTopic(types, topics.right_image, kImageType) ||
        !hasTopic(types, topics.left_info, kInfoType) ||
        !hasTopic(types, topics.right_info, kInfoType)) {
      continue;
    }
    if (!best.empty() && rank(topics) < rank(best.front())) best.clear();
    if (best.empty() || rank(topics) == rank(best.front())) best.push_back(topics);
  }
  if (best.empty()) {
    throw std::runtime_error(
        "no stereo pair (.../left/image..., .../right/image..., each with camera_info); "
        "specify the left and right image topics, image topics:" +
        imageTopics(types));
  }
  if (best.size() > 1) {
    throw std::runtime_error(
        "more than one stereo pair; specify the left and right image topics, image topics:" +
        imageTopics(types));
  }
  return best.front();
}

bool isRectifiedByName(const std::string& image_topic) {
  return contains(image_topic, "rect") || contains(image_topic, "kitti/camera_");
}

}  // namespace rotrocc
