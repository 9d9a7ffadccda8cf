#pragma once

#include <map>
#include <string>
#include <vector>

#include "bags/bag_reading.h"

namespace rotrocc {

/// Topics of a stereo pair; empty: not known.
struct StereoTopics {
  std::string left_image;
  std::string right_image;
  std::string left_info;
  std::string right_info;

  std::vector<std::string> all() const { return {left_image, right_image, left_info, right_info}; }
};

/// Types of all topics, such as "sensor_msgs/Image".
using TopicTypes = std::map<std::string, std::string>;

TopicTypes topicTypes(const Bags& bags);

/// Finds a stereo pair: two image topics whose names differ in left and right, cam0 and cam1,
/// infra1 and infra2, or Infrared_1 and Infrared_2, each with a camera_info in the same namespace
/// if `with_infos`. Prefers rectified to other images, gray to color, and raw to compressed ones.
/// Those that are `named` are taken as they are, both of the images or of camera_info. Throws
/// std::runtime_error with a list of the topics if there is no pair, or more than one.
StereoTopics findStereoTopics(const TopicTypes& types,
                              const StereoTopics& named = {},
                              bool with_infos = true);

}  // namespace rotrocc
