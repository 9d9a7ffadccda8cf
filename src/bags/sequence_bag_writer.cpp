#include "bags/sequence_bag_writer.h"

#include <filesystem>
#include <stdexcept>

#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Path.h>

namespace rotrocc {

SequenceBagWriter::SequenceBagWriter(const std::string& path,
                                     StereoSequence& sequence,
                                     const Options& options)
    : path_(path), unfinished_path_(path + ".part"), messages_(sequence, options) {
  try {
    bag_.open(unfinished_path_, rosbag::bagmode::Write);
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error(unfinished_path_ + " cannot be written: " + error.what());
  }
}

SequenceBagWriter::~SequenceBagWriter() {
  if (finished_) return;
  std::error_code ignored;
  std::filesystem::remove(unfinished_path_, ignored);
}

void SequenceBagWriter::writePair(int index) {
  const ros::Time time = messages_.stamp(index);
  writeGyroscope(time);
  beginStamp(time);
  if (index == 0) writeStatic();
  writeTruth();
  const SequenceMessages::Pair pair = messages_.read(index);
  writeCamera("left", pair.left);
  writeCamera("right", pair.right);
}

void SequenceBagWriter::finish() {
  writeGyroscope(ros::TIME_MAX);
  bag_.close();
  std::filesystem::rename(unfinished_path_, path_);
  finished_ = true;
}

void SequenceBagWriter::beginStamp(const ros::Time& stamp) {
  stamp_ = stamp;
  record_time_ = stamp;
}

void SequenceBagWriter::writeStatic() {
  write("/tf_static", messages_.mounts());
  const nav_msgs::Path& truth = messages_.groundTruth();
  if (!truth.poses.empty()) write("/ground_truth/path", truth);
}

/// The pose of this stamp, if there is one.
void SequenceBagWriter::writeTruth() {
  const nav_msgs::Path& truth = messages_.groundTruth();
  if (next_truth_ == truth.poses.size()) return;
  const geometry_msgs::PoseStamped& pose = truth.poses[next_truth_];
  if (pose.header.stamp != stamp_) return;
  write("/ground_truth/pose", pose);
  ++next_truth_;
}

/// Writes the samples before `end`.
void SequenceBagWriter::writeGyroscope(const ros::Time& end) {
  for (; next_sample_ < messages_.gyroscopeSamples(); ++next_sample_) {
    const sensor_msgs::Imu sample = messages_.gyroscope(next_sample_);
    if (sample.header.stamp >= end) return;
    beginStamp(sample.header.stamp);
    write("/imu/data", sample);
  }
}

void SequenceBagWriter::writeCamera(const std::string& side,
                                    const SequenceMessages::Camera& camera) {
  const std::string name = "/stereo/" + side;
  write(name + "/camera_info", *camera.info);
  write(name + (messages_.isRectified() ? "/image_rect" : "/image_raw"), *camera.image);
}

template <typename Message>
void SequenceBagWriter::write(const std::string& topic, const Message& message) {
  bag_.write(topic, record_time_, message);
  // Players sort by record time; equal times would have an undefined order.
  record_time_ += ros::Duration(0, 1);
}

void writeSequenceBag(const std::string& path,
                      StereoSequence& sequence,
                      const SequenceBagWriter::Options& options) {
  SequenceBagWriter writer(path, sequence, options);
  for (int index = 0; index < sequence.size(); ++index) writer.writePair(index);
  writer.finish();
}

}  // namespace rotrocc
