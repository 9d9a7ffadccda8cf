#include "bags/sequence_messages.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <sensor_msgs/image_encodings.h>
#include <tf2_eigen/tf2_eigen.h>
#include <boost/make_shared.hpp>

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

/// P[3] of the right camera, rounded so that those who divide it get the same baseline.
double shiftOf(const StereoCamera& camera) {
  const double product = -camera.fx * camera.baseline_m;
  const double nearer = std::nextafter(product, 0.0);
  const double farther = std::nextafter(product, 2.0 * product);
  for (const double shift : {product, nearer, farther}) {
    if (shift / -camera.fx == camera.baseline_m) return shift;
  }
  return product;
}

SequenceMessages::Camera message(sensor_msgs::CameraInfo info,
                                 const cv::Mat& image,
                                 const ros::Time& stamp) {
  info.header.stamp = stamp;
  return {boost::make_shared<sensor_msgs::CameraInfo>(info),
          toImage(info.header, sensor_msgs::image_encodings::MONO8, image)};
}

}  // namespace

SequenceMessages::SequenceMessages(StereoSequence& sequence, const Options& options)
    : sequence_(sequence),
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
}

ros::Time SequenceMessages::time(std::int64_t stamp_ns) const {
  return toRosTime(offset_ns_ + stamp_ns);
}

sensor_msgs::CameraInfo SequenceMessages::leftInfo() const {
  const StereoCamera& camera = calibration_.rectified;
  sensor_msgs::CameraInfo info = toCameraInfo(calibration_.left, camera, camera.cx, 0.0);
  info.header.frame_id = kCameraFrame;
  return info;
}

sensor_msgs::CameraInfo SequenceMessages::rightInfo() const {
  const StereoCamera& camera = calibration_.rectified;
  sensor_msgs::CameraInfo info =
      toCameraInfo(calibration_.right, camera, camera.cx_right, shiftOf(camera));
  info.header.frame_id = kCameraFrame;
  return info;
}

tf2_msgs::TFMessage SequenceMessages::mounts() const {
  tf2_msgs::TFMessage mounts;
  mounts.transforms.push_back(mount(sequence_.T_base_camera(), stamp(0), kCameraFrame));
  if (gyroscopeSamples() > 0) {
    mounts.transforms.push_back(mount(Eigen::Isometry3d::Identity(), stamp(0), kImuFrame));
  }
  return mounts;
}

sensor_msgs::Imu SequenceMessages::gyroscope(int sample) const {
  const GyroSample& measured = gyroscope_.samples.at(static_cast<std::size_t>(sample));
  const Eigen::Matrix3d R_base_gyro = sequence_.T_base_camera().linear() * gyroscope_.R_camera_gyro;
  sensor_msgs::Imu message;
  message.header.stamp = time(measured.stamp_ns);
  message.header.frame_id = kImuFrame;
  tf2::toMsg(Eigen::Vector3d(R_base_gyro * measured.rate_rps), message.angular_velocity);
  // Not measured, by the convention of sensor_msgs/Imu.
  message.orientation_covariance[0] = message.linear_acceleration_covariance[0] = -1.0;
  return message;
}

SequenceMessages::Pair SequenceMessages::read(int index) {
  StereoPair pair = sequence_.read(index);
  if (rectifier_) pair = rectifier_->rectify(pair);
  return {message(leftInfo(), pair.left, stamp(index)),
          message(rightInfo(), pair.right, stamp(index))};
}

}  // namespace rotrocc
