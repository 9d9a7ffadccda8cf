#pragma once

#include <memory>
#include <string>
#include <vector>

#include <sensor_msgs/Imu.h>

#include "bags/recording.h"
#include "input/stereo_pair_converter.h"
#include "sequences/stereo_sequence.h"

namespace rotrocc {

/// A sequence as messages of ROS. Images and infos of both cameras are in the frame of the left
/// one, stereo_left_optical: P of a rectified pair refers to it (sensor_msgs/CameraInfo), and
/// image_geometry requires equal frames. It may still be written by another program, e.g.
/// simulate_drive.
class SequenceRecording : public Recording {
 public:
  /// Throws like openStereoSequence() and readStereoCalibration(), and std::invalid_argument if the
  /// stamps are out of range.
  SequenceRecording(const std::string& directory, const RecordingOptions& options);

  std::string description() const override;
  int size() const override { return sequence_.size(); }
  bool isRaw() const override { return !calibration_.isRectified(); }
  ros::Time begin() const override { return stamp(0); }
  ros::Time end() const override { return stamp(size() - 1); }
  std::int64_t offset_ns() const override { return offset_ns_; }
  RecordedMessage firstInfos() const override { return infosOf(0); }

  /// Of the left camera and the gyroscope, which has the axes of base_link.
  tf2_msgs::TFMessage staticTransforms() const override;
  nav_msgs::Path truth() const override;
  Eigen::Isometry3d T_base_camera() const override { return sequence_.T_base_camera; }
  GyroRecording gyroscope(const std::string& name) const override {
    return sequence_.gyroscope(name);
  }

  /// The gyroscope in imu_link: the angular velocity only. Empty if there is none.
  std::vector<sensor_msgs::Imu> gyroscopeMessages() const;

  /// A message for each pair, with its images (mono8 or mono16) and infos.
  void select(const ros::Time& from, const ros::Time& to, bool with_tf) override;
  bool hasNext() const override;
  bool next(RecordedMessage& message) override;
  std::string leftOut() const override { return sequence_.pairs.leftOut(); }

 private:
  ros::Time stamp(int pair) const;
  RecordedMessage infosOf(int pair) const;
  bool atEnd() const;

  std::string directory_;
  StereoSequence sequence_;
  std::int64_t offset_ns_;
  StereoCalibration calibration_;                             // of the images of next()
  std::shared_ptr<const StereoCalibration> raw_calibration_;  // of images that are rectified
  StereoPairConverter converter_;                             // of images that are rectified
  int next_pair_ = 0;
  ros::Time last_;
};

}  // namespace rotrocc
