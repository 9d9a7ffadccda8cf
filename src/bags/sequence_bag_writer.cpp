#include "bags/sequence_bag_writer.h"

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include <geometry_msgs/PoseStamped.h>
#include <rosbag/bag.h>

namespace rotrocc {
namespace {

/// Writes into `path`.part until finish().
class Writer {
 public:
  Writer(const std::string& path, const SequenceRecording& recording)
      : path_(path),
        recording_(recording),
        image_topic_(recording.isRaw() ? "/image_raw" : "/image_rect"),
        truth_(recording.truth()),
        gyroscope_(recording.gyroscopeMessages()) {
    try {
      bag_.open(unfinishedPath(), rosbag::bagmode::Write);
    } catch (const rosbag::BagException& error) {
      throw std::runtime_error(unfinishedPath() + " cannot be written: " + error.what());
    }
  }

  /// Removes an unfinished file.
  ~Writer() {
    std::error_code ignored;
    std::filesystem::remove(unfinishedPath(), ignored);
  }

  void write(const RecordedMessage& pair) {
    beginPair(pair.time);
    write("/stereo/left/camera_info", *pair.left_info);
    write("/stereo/left" + image_topic_, *pair.left_image);
    write("/stereo/right/camera_info", *pair.right_info);
    write("/stereo/right" + image_topic_, *pair.right_image);
  }

  /// Renames the complete file to its final name.
  void finish() {
    writeGyroscope(ros::TIME_MAX);
    bag_.close();
    std::filesystem::rename(unfinishedPath(), path_);
  }

 private:
  std::string unfinishedPath() const { return path_ + ".part"; }

  /// Writes what is before the first message of a pair.
  void beginPair(const ros::Time& time) {
    writeGyroscope(time);
    time_ = time;
    if (time == recording_.begin()) writeStatic();
    const auto& poses = truth_.poses;
    if (next_truth_ == poses.size() || poses[next_truth_].header.stamp != time) return;
    write("/ground_truth/pose", poses[next_truth_]);
    ++next_truth_;
  }

  void writeStatic() {
    write("/tf_static", recording_.staticTransforms());
    if (!truth_.poses.empty()) write("/ground_truth/path", truth_);
  }

  /// Writes the samples before `end`.
  void writeGyroscope(const ros::Time& end) {
    for (; next_sample_ < gyroscope_.size(); ++next_sample_) {
      const sensor_msgs::Imu& sample = gyroscope_[next_sample_];
      if (sample.header.stamp >= end) return;
      time_ = sample.header.stamp;
      write("/imu/data", sample);
    }
  }

  template <typename Message>
  void write(const std::string& topic, const Message& message) {
    bag_.write(topic, time_, message);
    // Players sort by record time; equal times would have an undefined order.
    time_ += ros::Duration(0, 1);
  }

  std::string path_;
  const SequenceRecording& recording_;
  std::string image_topic_;
  nav_msgs::Path truth_;
  std::vector<sensor_msgs::Imu> gyroscope_;
  std::size_t next_truth_ = 0;
  std::size_t next_sample_ = 0;
  rosbag::Bag bag_;
  ros::Time time_;  // of the next message
};

}  // namespace

void writeSequenceBag(const std::string& path,
                      SequenceRecording& recording,
                      const std::function<void()>& on_pair) {
  Writer writer(path, recording);
  recording.select(recording.begin(), recording.end(), false);
  RecordedMessage pair;
  while (recording.next(pair)) {
    writer.write(pair);
    if (on_pair) on_pair();
  }
  writer.finish();
}

void writeSequenceBag(const std::string& path,
                      const std::string& directory,
                      const SequenceRecording::Options& options) {
  SequenceRecording recording(directory, options);
  writeSequenceBag(path, recording);
}

}  // namespace rotrocc
