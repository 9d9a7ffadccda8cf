#pragma once

#include <map>
#include <string>
#include <vector>

#include <rosbag/bag.h>

namespace rotrocc {

/// Where a bag keeps its stereo pair.
struct StereoTopics {
  std::string left_image;
  std::string right_image;
  std::string left_info;
  std::string right_info;

  std::vector<std::string> all() const { return {left_image, right_image, left_info, right_info}; }
};

/// Types of all topics, such as "sensor_msgs/Image".
using TopicTypes = std::map<std::string, std::string>;

TopicTypes topicTypes(const rosbag::Bag& bag);

/// Finds the pair: two image topics whose names differ in left and right, with a camera_info beside
/// each, as image_transport has it. Rectified images go before others, gray before colour. Where a
/// bag has only image_raw, as kitti2bag makes of raw drives, its images are taken as rectified.
/// `left_image` and `right_image` name the pair where it cannot be found; empty: find it.
/// Throws std::runtime_error that lists the topics if there is no pair, or more than one.
StereoTopics findStereoTopics(const TopicTypes& types,
                              const std::string& left_image = "",
                              const std::string& right_image = "");

}  // namespace rotrocc
