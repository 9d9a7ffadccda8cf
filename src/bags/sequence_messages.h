#pragma once

#include <cstdint>
#include <optional>

#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Path.h>
#include <ros/time.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <tf2_msgs/TFMessage.h>

#include "rectification/stereo_rectifier.h"
#include "sequences/stereo_sequence.h"

namespace rotrocc {

/// The messages that a sequence is in ROS. Images and infos of both cameras are in the frame of the
/// left one, stereo_left_optical: P of a rectified pair refers to it (sensor_msgs/CameraInfo), and
/// image_geometry requires equal frames.
class SequenceMessages {
 public:
  struct Options {
    /// Time of the first pair of a sequence whose stamps are since 1970, otherwise of its time 0;
    /// by default as it is, or kKittiStart_s.
    std::optional<std::int64_t> start_time_s;
    bool rectify = false;  ///< images that are not rectified
  };

  /// One camera at one time.
  struct Camera {
    sensor_msgs::CameraInfo::Ptr info;
    sensor_msgs::Image::Ptr image;  ///< mono8
  };

  struct Pair {
    Camera left;
    Camera right;
  };

  /// `sequence` must outlive this. Throws std::invalid_argument if the stamps are out of range.
  SequenceMessages(StereoSequence& sequence, const Options& options);

  const StereoSequence& sequence() const { return sequence_; }
  ros::Time stamp(int index) const { return time(sequence_.stamp_ns(index)); }

  /// Whether those of read() are.
  bool isRectified() const { return calibration_.isRectified(); }

  /// Of one camera, without a stamp.
  sensor_msgs::CameraInfo leftInfo() const;
  sensor_msgs::CameraInfo rightInfo() const;

  /// base_link -> stereo_left_optical: the rectified left camera; and the gyroscope, if there is
  /// one, with the axes of base_link.
  tf2_msgs::TFMessage mounts() const;

  /// Of base_link in odom; empty if it is not known.
  const nav_msgs::Path& groundTruth() const { return ground_truth_; }

  /// In imu_link: the angular velocity only.
  int gyroscopeSamples() const { return static_cast<int>(gyroscope_.samples.size()); }
  sensor_msgs::Imu gyroscope(int sample) const;

  /// Throws std::runtime_error like StereoSequence::read().
  Pair read(int index);

 private:
  ros::Time time(std::int64_t stamp_ns) const;

  StereoSequence& sequence_;
  std::int64_t offset_ns_;
  StereoCalibration calibration_;  // of the images of read()
  std::optional<StereoRectifier> rectifier_;
  nav_msgs::Path ground_truth_;
  GyroRecording gyroscope_;
};

}  // namespace rotrocc
