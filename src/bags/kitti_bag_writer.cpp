#include "bags/kitti_bag_writer.h"

#include <filesystem>
#include <limits>
#include <stdexcept>

#include <cv_bridge/cv_bridge.h>
#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/distortion_models.h>
#include <sensor_msgs/image_encodings.h>
#include <std_msgs/Header.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_msgs/TFMessage.h>

#include "bags/ground_truth.h"
#include "bags/kitti_mount.h"
#include "inertial/gyro_file.h"
#include "input/message_conversion.h"

namespace rotrocc {
namespace {

constexpr std::int64_t kNsPerS = 1000000000;
const char* const kBaseFrame = "base_link";
const char* const kOdomFrame = "odom";
const char* const kCameraFrame = "stereo_left_optical";
const char* const kImuFrame = "imu_link";

sensor_msgs::CameraInfo cameraInfo(const StereoCamera& camera, double cx, double baseline_m) {
  sensor_msgs::CameraInfo info;
  info.header.frame_id = kCameraFrame;
  info.width = camera.width;
  info.height = camera.height;
  info.distortion_model = sensor_msgs::distortion_models::PLUMB_BOB;
  info.D.assign(5, 0.0);
  info.K = {camera.fx, 0, cx, 0, camera.fy, camera.cy, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {camera.fx, 0, cx, -camera.fx * baseline_m, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0};
  return info;
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

KittiBagWriter::KittiBagWriter(const std::string& path,
                               const KittiSequence& sequence,
                               std::int64_t start_time_s)
    : path_(path),
      unfinished_path_(path + ".part"),
      sequence_(sequence),
      start_time_s_(start_time_s) {
  const std::int64_t last_s = start_time_s + sequence.stamp_ns(sequence.size() - 1) / kNsPerS;
  if (start_time_s < 1 || last_s >= std::numeric_limits<std::uint32_t>::max()) {
    throw std::invalid_argument("start time " + std::to_string(start_time_s) +
                                " s is out of the range of ROS stamps: choose one from 1 to 4e9");
  }
  Trajectory poses = sequence.groundTruth();
  for (StampedPose& pose : poses) pose.stamp_ns += start_time_s * kNsPerS;
  ground_truth_ = groundTruthPath(poses, kittiMount(), kOdomFrame);
  const std::string imu = sequence.directory() + "/imu.csv";
  if (std::filesystem::exists(imu)) gyroscope_ = readGyroFile(imu);
  try {
    bag_.open(unfinished_path_, rosbag::bagmode::Write);
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error(unfinished_path_ + " cannot be written: " + error.what());
  }
}

KittiBagWriter::~KittiBagWriter() {
  if (finished_) return;
  std::error_code ignored;
  std::filesystem::remove(unfinished_path_, ignored);
}

void KittiBagWriter::writePair(int index) {
  writeGyroscope(stamp(index));
  beginStamp(stamp(index));
  if (index == 0) writeStatic();
  if (sequence_.hasGroundTruth()) write("/ground_truth/pose", ground_truth_.poses.at(index));
  const StereoCamera& camera = sequence_.camera();
  writeCamera("/stereo/left", cameraInfo(camera, camera.cx, 0.0), sequence_.readLeft(index));
  writeCamera("/stereo/right",
              cameraInfo(camera, camera.cx_right, camera.baseline_m),
              sequence_.readRight(index));
}

void KittiBagWriter::finish() {
  writeGyroscope(ros::TIME_MAX);
  bag_.close();
  std::filesystem::rename(unfinished_path_, path_);
  finished_ = true;
}

ros::Time KittiBagWriter::stamp(int index) const {
  return toRosTime(start_time_s_ * kNsPerS + sequence_.stamp_ns(index));
}

void KittiBagWriter::beginStamp(const ros::Time& stamp) {
  stamp_ = stamp;
  record_time_ = stamp;
}

void KittiBagWriter::writeStatic() {
  tf2_msgs::TFMessage mounts;
  mounts.transforms.push_back(mount(kittiMount(), stamp_, kCameraFrame));
  if (!gyroscope_.empty()) {
    mounts.transforms.push_back(mount(Eigen::Isometry3d::Identity(), stamp_, kImuFrame));
  }
  write("/tf_static", mounts);
  if (sequence_.hasGroundTruth()) write("/ground_truth/path", ground_truth_);
}

/// Writes the samples before `end`.
void KittiBagWriter::writeGyroscope(const ros::Time& end) {
  for (; next_sample_ < gyroscope_.size(); ++next_sample_) {
    const GyroSample& sample = gyroscope_[next_sample_];
    const ros::Time stamp = toRosTime(start_time_s_ * kNsPerS + sample.stamp_ns);
    if (stamp >= end) return;
    beginStamp(stamp);
    sensor_msgs::Imu message;
    message.header.stamp = stamp;
    message.header.frame_id = kImuFrame;
    tf2::toMsg(Eigen::Vector3d(kittiMount().linear() * sample.rate_rps), message.angular_velocity);
    // Not measured, by the convention of sensor_msgs/Imu.
    message.orientation_covariance[0] = message.linear_acceleration_covariance[0] = -1.0;
    write("/imu/data", message);
  }
}

void KittiBagWriter::writeCamera(const std::string& camera_topic,
                                 sensor_msgs::CameraInfo info,
                                 const cv::Mat& image) {
  info.header.stamp = stamp_;
  write(camera_topic + "/camera_info", info);
  write(camera_topic + "/image_rect",
        *cv_bridge::CvImage(info.header, sensor_msgs::image_encodings::MONO8, image).toImageMsg());
}

template <typename Message>
void KittiBagWriter::write(const std::string& topic, const Message& message) {
  bag_.write(topic, record_time_, message);
  // Players sort by record time; equal times would have an undefined order.
  record_time_ += ros::Duration(0, 1);
}

}  // namespace rotrocc
