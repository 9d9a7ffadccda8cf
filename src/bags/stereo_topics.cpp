#include "bags/stereo_topics.h"

#include <stdexcept>
#include <utility>
#include <vector>

#include <boost/algorithm/string/erase.hpp>
#include <boost/algorithm/string/predicate.hpp>

#include "input/camera_calibration.h"

namespace rotrocc {
namespace {

const char* const kInfoType = "sensor_msgs/CameraInfo";
const char* const kCompressed = "/compressed";

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

bool isImage(const TopicTypes& types, const std::string& topic) {
  const auto found = types.find(topic);
  if (found == types.end()) return false;
  // compressedDepth and theora are of other types, or not of a camera.
  return found->second == "sensor_msgs/Image" ||
         (found->second == "sensor_msgs/CompressedImage" && !contains(topic, "Depth"));
}

bool isInfo(const TopicTypes& types, const std::string& topic) {
  const auto found = types.find(topic);
  return found != types.end() && found->second == kInfoType;
}

/// The camera_info topic in the namespace of an image topic.
std::string infoTopicOf(std::string image_topic) {
  if (const auto end = image_topic.rfind(kCompressed); end != std::string::npos) {
    image_topic.resize(end);
  }
  const std::string data = "/image/data";  // of realsense-viewer
  if (boost::algorithm::ends_with(image_topic, data)) {
    return boost::algorithm::erase_last_copy(image_topic, data) + "/info/camera_info";
  }
  return image_topic.substr(0, image_topic.rfind('/') + 1) + "camera_info";
}

StereoTopics withInfos(const std::string& left_image, const std::string& right_image) {
  return {left_image, right_image, infoTopicOf(left_image), infoTopicOf(right_image)};
}

/// The name with the last name of a left camera replaced by that of the right one; empty if it has
/// none.
std::string rightOf(const std::string& left_image) {
  for (const auto& [left, right] : {std::pair<std::string, const char*>{"left", "right"},
                                    {"cam0", "cam1"},
                                    {"infra1", "infra2"},
                                    {"Infrared_1", "Infrared_2"}}) {
    const std::size_t position = left_image.rfind(left);
    if (position == std::string::npos) continue;
    return std::string(left_image).replace(position, left.size(), right);
  }
  return "";
}

/// Lower is better.
int rank(const StereoTopics& topics) {
  const bool rectified = isRectifiedByName(topics.left_image);
  const bool color = contains(topics.left_image, "color");
  const bool compressed = contains(topics.left_image, kCompressed);
  return (rectified ? 0 : 4) + (color ? 2 : 0) + (compressed ? 1 : 0);
}

std::string imageTopics(const TopicTypes& types) {
  std::string list;
  for (const auto& [topic, type] : types) {
    if (isImage(types, topic)) list += "\n  " + topic;
  }
  return list.empty() ? " none" : list;
}

void requireTopics(const TopicTypes& types, const StereoTopics& topics, bool with_infos) {
  for (const std::string& image : {topics.left_image, topics.right_image}) {
    if (isImage(types, image)) continue;
    throw std::runtime_error(
        "no topic '" + image +
        "' of type sensor_msgs/Image or CompressedImage, image topics:" + imageTopics(types));
  }
  for (const std::string& info : {topics.left_info, topics.right_info}) {
    if (!with_infos || isInfo(types, info)) continue;
    throw std::runtime_error("no topic '" + info + "' of type " + kInfoType +
                             ", which is required with the images: name another one (left_info, "
                             "right_info), or the files of a calibration (calibration)");
  }
}

/// All pairs of the best rank.
std::vector<StereoTopics> bestTopics(const TopicTypes& types, bool with_infos) {
  std::vector<StereoTopics> best;
  for (const auto& [topic, type] : types) {
    const StereoTopics topics = withInfos(topic, rightOf(topic));
    if (!isImage(types, topics.left_image) || !isImage(types, topics.right_image)) continue;
    if (with_infos && !(isInfo(types, topics.left_info) && isInfo(types, topics.right_info))) {
      continue;
    }
    if (!best.empty() && rank(topics) < rank(best.front())) best.clear();
    if (best.empty() || rank(topics) == rank(best.front())) best.push_back(topics);
  }
  return best;
}

StereoTopics onlyPair(const TopicTypes& types, bool with_infos) {
  const std::vector<StereoTopics> best = bestTopics(types, with_infos);
  if (best.size() == 1) return best.front();
  const bool lacks_infos = best.empty() && !bestTopics(types, false).empty();
  throw std::runtime_error(
      (best.size() > 1 ? "more than one stereo pair; specify the left and right image topics"
       : lacks_infos ? "no stereo pair with camera_info: name its topics (left_info, right_info), "
                       "or the files of a calibration (calibration)"
                     : "no stereo pair (.../left/image..., .../right/image..., each with "
                       "camera_info); specify the left and right image topics") +
      (", image topics:" + imageTopics(types)));
}

}  // namespace

TopicTypes topicTypes(const Bags& bags) {
  TopicTypes types;
  BagView view(bags);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    types[connection->topic] = connection->datatype;
  }
  return types;
}

StereoTopics findStereoTopics(const TopicTypes& types, const StereoTopics& named, bool with_infos) {
  if (named.left_image.empty() != named.right_image.empty() ||
      named.left_info.empty() != named.right_info.empty()) {
    throw std::runtime_error("specify both the left and the right topic, or none");
  }
  const bool names_infos = !named.left_info.empty();
  StereoTopics topics = withInfos(named.left_image, named.right_image);
  if (named.left_image.empty()) topics = onlyPair(types, with_infos && !names_infos);
  if (names_infos) {
    topics.left_info = named.left_info;
    topics.right_info = named.right_info;
  }
  requireTopics(types, topics, with_infos);
  return topics;
}

}  // namespace rotrocc
