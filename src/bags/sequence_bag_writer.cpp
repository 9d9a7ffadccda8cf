#include "bags/sequence_bag_writer.h"

#include <filesystem>
#include <stdexcept>
#include <vector>

#include <geometry_msgs/PoseStamped.h>
#include <rosbag/bag.h>

namespace rotrocc {
namespace {

void writeMessages(rosbag::Bag& bag,
                   SequenceRecording& recording,
                   const std::function<void()>& on_pair) {
  const std::string images = recording.isRaw() ? "/image_raw" : "/image_rect";
  const nav_msgs::Path truth = recording.truth();
  const std::vector<sensor_msgs::Imu> samples = recording.gyroscopeMessages();
  auto next_pose = truth.poses.begin();
  auto next_sample = samples.begin();
  ros::Time time;  // of the next message
  const auto write = [&](const std::string& topic, const auto& message) {
    bag.write(topic, time, message);
    // Players sort by record time; equal times would have an undefined order.
    time += ros::Duration(0, 1);
  };
  const auto writeSamplesBefore = [&](const ros::Time& end) {
    for (; next_sample != samples.end() && next_sample->header.stamp < end; ++next_sample) {
      time = next_sample->header.stamp;
      write("/imu/data", *next_sample);
    }
  };

  RecordedMessage pair;
  while (recording.next(pair)) {
    writeSamplesBefore(pair.time);
    time = pair.time;
    if (pair.time == recording.begin()) {
      write("/tf_static", recording.staticTransforms());
      if (!truth.poses.empty()) write("/ground_truth/path", truth);
    }
    if (next_pose != truth.poses.end() && next_pose->header.stamp == pair.time) {
      write("/ground_truth/pose", *next_pose++);
    }
    write("/stereo/left/camera_info", *pair.left_info);
    write("/stereo/left" + images, *pair.left_image);
    write("/stereo/right/camera_info", *pair.right_info);
    write("/stereo/right" + images, *pair.right_image);
    if (on_pair) on_pair();
  }
  writeSamplesBefore(ros::TIME_MAX);
}

}  // namespace

void writeSequenceBag(const std::string& path,
                      SequenceRecording& recording,
                      const std::function<void()>& on_pair) {
  const std::string unfinished = path + ".part";
  try {
    rosbag::Bag bag(unfinished, rosbag::bagmode::Write);
    recording.select(recording.begin(), recording.end(), false);
    writeMessages(bag, recording, on_pair);
    bag.close();
  } catch (const std::exception& error) {
    std::error_code ignored;
    std::filesystem::remove(unfinished, ignored);
    throw std::runtime_error(unfinished + " cannot be written: " + error.what());
  }
  std::filesystem::rename(unfinished, path);
}

void writeSequenceBag(const std::string& path, const std::string& directory, bool rectify) {
  RecordingOptions options;
  options.raw_sequence = !rectify;
  SequenceRecording recording(directory, options);
  writeSequenceBag(path, recording);
}

}  // namespace rotrocc
