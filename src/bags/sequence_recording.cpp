#include "bags/sequence_recording.h"

#include <limits>
#include <stdexcept>
#include <utility>

#include <cv_bridge/cv_bridge.h>
#include <tf2_eigen/tf2_eigen.h>
#include <boost/make_shared.hpp>

#include "input/camera_calibration.h"
#include "input/input_error.h"
#include "input/message_conversion.h"

namespace rotrocc {
namespace {

constexpr std::int64_t kNsPerS = 1000000000;
const char* const kBaseFrame = "base_link";
const char* const kCameraFrame = "stereo_left_optical";
const char* const kImuFrame = "imu_link";

void requireRosStamps(const StereoSequence& sequence, std::int64_t offset_ns) {
  const std::int64_t first_s = (sequence.stamp_ns(0) + offset_ns) / kNsPerS;
  const std::int64_t last_s = (sequence.stamp_ns(sequence.size() - 1) + offset_ns) / kNsPerS;
  if (first_s >= 1 && last_s < std::numeric_limits<std::uint32_t>::max()) return;
  throw std::invalid_argument("the stamps from " + std::to_string(first_s) + " to " +
                              std::to_string(last_s) +
                              " s are out of the range of ROS, which is from 1 to 4e9 s");
}

/// By what the node requires of camera_info.
void requireValid(const StereoCalibration& calibration, const std::string& directory) {
  try {
    const auto [left, right] = toCameraInfos(calibration);
    toStereoCalibration(left, right);
  } catch (const InputError& error) {
    throw std::runtime_error("the calibration of " + directory + ": " + error.what());
  }
}

sensor_msgs::Image::Ptr toGrayImage(const std_msgs::Header& header, const cv::Mat& pixels) {
  const bool has_16_bits = pixels.depth() == CV_16U;
  return cv_bridge::CvImage(header, has_16_bits ? "mono16" : "mono8", pixels).toImageMsg();
}

}  // namespace

SequenceRecording::SequenceRecording(const std::string& directory, const RecordingOptions& options)
    : directory_(directory),
      sequence_(openStereoSequence(directory, options.sequence)),
      offset_ns_(rosTimeOffset_ns(sequence_)),
      calibration_(sequence_.calibration) {
  requireRosStamps(sequence_, offset_ns_);
  requireValid(calibration_, directory);
  if (!options.raw_sequence && !calibration_.isRectified()) {
    raw_calibration_ = std::make_shared<const StereoCalibration>(calibration_);
    calibration_ = rectifiedCalibration(calibration_.rectified);
  }
  last_ = end();
}

std::string SequenceRecording::description() const {
  return "the pairs of " + directory_ + (raw_calibration_ ? ", rectified" : "");
}

tf2_msgs::TFMessage SequenceRecording::staticTransforms() const {
  const std::int64_t stamp_ns = toNanoseconds(begin());
  tf2_msgs::TFMessage mounts;
  mounts.transforms.push_back(toTransform(T_base_camera(), stamp_ns, kBaseFrame, kCameraFrame));
  if (!gyroscope("").samples.empty()) {
    mounts.transforms.push_back(
        toTransform(Eigen::Isometry3d::Identity(), stamp_ns, kBaseFrame, kImuFrame));
  }
  return mounts;
}

nav_msgs::Path SequenceRecording::truth() const {
  Trajectory poses = sequence_.ground_truth;
  for (StampedPose& pose : poses) pose.stamp_ns += offset_ns_;
  return pathOfBase(poses, T_base_camera());
}

std::vector<sensor_msgs::Imu> SequenceRecording::gyroscopeMessages() const {
  const GyroRecording gyro = gyroscope("");
  const Eigen::Matrix3d R_base_gyro = T_base_camera().linear() * gyro.R_camera_gyro;
  std::vector<sensor_msgs::Imu> messages;
  for (const GyroSample& sample : gyro.samples) {
    sensor_msgs::Imu& message = messages.emplace_back();
    message.header.stamp = toRosTime(offset_ns_ + sample.stamp_ns);
    message.header.frame_id = kImuFrame;
    tf2::toMsg(Eigen::Vector3d(R_base_gyro * sample.rate_rps), message.angular_velocity);
    // Not measured, by the convention of sensor_msgs/Imu.
    message.orientation_covariance[0] = message.linear_acceleration_covariance[0] = -1.0;
  }
  return messages;
}

void SequenceRecording::select(const ros::Time& from, const ros::Time& to, bool /*with_tf*/) {
  next_pair_ = 0;
  while (next_pair_ < size() && stamp(next_pair_) < from) ++next_pair_;
  last_ = to;
}

bool SequenceRecording::hasNext() const {
  return atEnd() || sequence_.pairs.hasFiles(next_pair_);
}

bool SequenceRecording::next(RecordedMessage& message) {
  if (atEnd()) return false;
  const int index = next_pair_++;
  StereoPair pair;
  try {
    pair = sequence_.read(index);
  } catch (const std::runtime_error& error) {
    throw InputError(DropReason::kImageData, error.what());
  }
  if (raw_calibration_) {
    ReceivedPair raw;
    raw.images = {toGrayImage({}, pair.left), toGrayImage({}, pair.right)};
    raw.camera = calibration_.rectified;
    raw.calibration = raw_calibration_;
    pair = converter_.convert(raw);
  }
  message = infosOf(index);
  message.left_image = toGrayImage(message.left_info->header, pair.left);
  message.right_image = toGrayImage(message.right_info->header, pair.right);
  return true;
}

ros::Time SequenceRecording::stamp(int pair) const {
  return toRosTime(offset_ns_ + sequence_.stamp_ns(pair));
}

RecordedMessage SequenceRecording::infosOf(int pair) const {
  auto [left, right] = toCameraInfos(calibration_);
  left.header.frame_id = right.header.frame_id = kCameraFrame;
  left.header.stamp = right.header.stamp = stamp(pair);
  RecordedMessage message;
  message.time = stamp(pair);
  message.left_info = boost::make_shared<sensor_msgs::CameraInfo>(std::move(left));
  message.right_info = boost::make_shared<sensor_msgs::CameraInfo>(std::move(right));
  return message;
}

bool SequenceRecording::atEnd() const {
  return next_pair_ == size() || stamp(next_pair_) > last_;
}

}  // namespace rotrocc
