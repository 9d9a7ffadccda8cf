#include "bags/sequence_bag_writer.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include <cv_bridge/cv_bridge.h>
#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/image_encodings.h>
#include <std_msgs/Header.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_msgs/TFMessage.h>

#include "bags/ground_truth.h"
#include "input/message_conversion.h"
#include "sequences/camera_info_calibration.h"

namespace rotrocc {
namespace {

constexpr std::int64_t kNsPerS = 1000000000;
const char* const kBaseFrame = "base_link";
const char* const kOdomFrame = "odom";
const char* const kCameraFrame = "stereo_left_optical";
const char* const kImuFrame = "imu_link";

std::int64_t offsetOf(const StereoSequence& sequence, std::optional<std::int64_t> start_time_s) {
  const std::int64_t usual_ns = rosTimeOffset_ns(sequence);
  if (!start_time_s) return usual_ns;
  constexpr std::int64_t kMaxStart_s = std::numeric_limits<std::uint32_t>::max();
  const std::int64_t start_s = std::clamp<std::int64_t>(*start_time_s, -1, kMaxStart_s);
  return start_s * kNsPerS - (usual_ns == 0 ? sequence.stamp_ns(0) : 0);
}

void requireRosStamps(const StereoSequence& sequence, std::int64_t offset_ns) {
  const std::int64_t first_s = (sequence.stamp_ns(0) + offset_ns) / kNsPerS;
  const std::int64_t last_s = (sequence.stamp_ns(sequence.size() - 1) + offset_ns) / kNsPerS;
  if (first_s >= 1 && last_s < std::numeric_limits<std::uint32_t>::max()) return;
  throw std::invalid_argument("the stamps from " + std::to_string(first_s) + " to " +
                              std::to_string(last_s) +
                              " s are out of the range of ROS: choose a start time from 1 to 4e9");
}

geometry_msgs::TransformStamped mount(const Eigen::Isometry3d& T_base_sensor,
                                      const ros::Time& stamp,
                                      const std::string& frame) {
  geometry_msgs::TransformStamped transform = tf2::eigenToTransform(T_base_sensor);
  transform.header.frame_id = kBaseFrame;
  transform.header.stamp = stamp;
  transform.child_frame_id = frame;
  return transform;
}

}  // namespace

SequenceBagWriter::SequenceBagWriter(const std::string& path,
                                     StereoSequence& sequence,
                                     const Options& options)
    : path_(path),
      unfinished_path_(path + ".part"),
      sequence_(sequence),
      offset_ns_(offsetOf(sequence, options.start_time_s)),
      calibration_(sequence.calibration()),
      gyroscope_(sequence.gyroscope("")) {
  requireRosStamps(sequence, offset_ns_);
  if (options.rectify && !calibration_.isRectified()) {
    rectifier_.emplace(calibration_);
    calibration_ = rectifiedCalibration(calibration_.rectified);
  }
  Trajectory poses = sequence.groundTruth();
  for (StampedPose& pose : poses) pose.stamp_ns += offset_ns_;
  ground_truth_ = groundTruthPath(poses, sequence.T_base_camera(), kOdomFrame);
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
  const ros::Time time = stamp(sequence_.stamp_ns(index));
  writeGyroscope(time);
  beginStamp(time);
  if (index == 0) writeStatic();
  writeTruth();
  StereoPair pair = sequence_.read(index);
  if (rectifier_) pair = rectifier_->rectify(pair);
  const StereoCamera& camera = calibration_.rectified;
  const double shift_px = -camera.fx * camera.baseline_m;
  writeCamera("left", toCameraInfo(calibration_.left, camera, camera.cx, 0.0), pair.left);
  writeCamera(
      "right", toCameraInfo(calibration_.right, camera, camera.cx_right, shift_px), pair.right);
}

void SequenceBagWriter::finish() {
  writeGyroscope(ros::TIME_MAX);
  bag_.close();
  std::filesystem::rename(unfinished_path_, path_);
  finished_ = true;
}

ros::Time SequenceBagWriter::stamp(std::int64_t stamp_ns) const {
  return toRosTime(offset_ns_ + stamp_ns);
}

void SequenceBagWriter::beginStamp(const ros::Time& stamp) {
  stamp_ = stamp;
  record_time_ = stamp;
}

void SequenceBagWriter::writeStatic() {
  tf2_msgs::TFMessage mounts;
  mounts.transforms.push_back(mount(sequence_.T_base_camera(), stamp_, kCameraFrame));
  if (!gyroscope_.samples.empty()) {
    mounts.transforms.push_back(mount(Eigen::Isometry3d::Identity(), stamp_, kImuFrame));
  }
  write("/tf_static", mounts);
  if (!ground_truth_.poses.empty()) write("/ground_truth/path", ground_truth_);
}

/// The pose of this stamp, if there is one.
void SequenceBagWriter::writeTruth() {
  if (next_truth_ == ground_truth_.poses.size()) return;
  const geometry_msgs::PoseStamped& pose = ground_truth_.poses[next_truth_];
  if (pose.header.stamp != stamp_) return;
  write("/ground_truth/pose", pose);
  ++next_truth_;
}

/// Writes the samples before `end`.
void SequenceBagWriter::writeGyroscope(const ros::Time& end) {
  const Eigen::Matrix3d R_base_gyro = sequence_.T_base_camera().linear() * gyroscope_.R_camera_gyro;
  for (; next_sample_ < gyroscope_.samples.size(); ++next_sample_) {
    const GyroSample& sample = gyroscope_.samples[next_sample_];
    const ros::Time time = stamp(sample.stamp_ns);
    if (time >= end) return;
    beginStamp(time);
    sensor_msgs::Imu message;
    message.header.stamp = time;
    message.header.frame_id = kImuFrame;
    tf2::toMsg(Eigen::Vector3d(R_base_gyro * sample.rate_rps), message.angular_velocity);
    // Not measured, by the convention of sensor_msgs/Imu.
    message.orientation_covariance[0] = message.linear_acceleration_covariance[0] = -1.0;
    write("/imu/data", message);
  }
}

void SequenceBagWriter::writeCamera(const std::string& side,
                                    sensor_msgs::CameraInfo info,
                                    const cv::Mat& image) {
  const std::string camera = "/stereo/" + side;
  info.header.stamp = stamp_;
  info.header.frame_id = kCameraFrame;
  write(camera + "/camera_info", info);
  write(camera + (calibration_.isRectified() ? "/image_rect" : "/image_raw"),
        *cv_bridge::CvImage(info.header, sensor_msgs::image_encodings::MONO8, image).toImageMsg());
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
