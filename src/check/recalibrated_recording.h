#pragma once

#include <utility>

#include <sensor_msgs/CameraInfo.h>
#include <boost/make_shared.hpp>

#include "bags/recording.h"
#include "input/camera_calibration.h"
#include "rectification/stereo_calibration.h"

namespace rotrocc {

/// A recording by another calibration than its own.
class RecalibratedRecording : public Recording {
 public:
  RecalibratedRecording(Recording& recording, const StereoCalibration& calibration)
      : recording_(recording) {
    const auto [left, right] = toCameraInfos(calibration);
    left_ = left;
    right_ = right;
  }

  std::string description() const override { return recording_.description(); }
  int size() const override { return recording_.size(); }
  bool isRaw() const override { return true; }
  ros::Time begin() const override { return recording_.begin(); }
  ros::Time end() const override { return recording_.end(); }
  std::int64_t offset_ns() const override { return recording_.offset_ns(); }
  RecordedMessage firstInfos() const override {
    RecordedMessage infos = recording_.firstInfos();
    replace(infos);
    return infos;
  }
  tf2_msgs::TFMessage staticTransforms() const override { return recording_.staticTransforms(); }
  nav_msgs::Path truth() const override { return recording_.truth(); }
  Eigen::Isometry3d T_base_camera() const override { return recording_.T_base_camera(); }
  GyroRecording gyroscope(const std::string& name) const override {
    return recording_.gyroscope(name);
  }
  void select(const ros::Time& from, const ros::Time& to, bool with_tf) override {
    recording_.select(from, to, with_tf);
  }
  bool hasNext() const override { return recording_.hasNext(); }
  bool next(RecordedMessage& message) override {
    if (!recording_.next(message)) return false;
    replace(message);
    return true;
  }
  std::string leftOut() const override { return recording_.leftOut(); }

 private:
  void replace(RecordedMessage& message) const {
    if (message.left_info) message.left_info = withHeaderOf(*message.left_info, left_);
    if (message.right_info) message.right_info = withHeaderOf(*message.right_info, right_);
  }

  static sensor_msgs::CameraInfo::ConstPtr withHeaderOf(const sensor_msgs::CameraInfo& recorded,
                                                        sensor_msgs::CameraInfo info) {
    info.header = recorded.header;
    return boost::make_shared<sensor_msgs::CameraInfo>(std::move(info));
  }

  Recording& recording_;
  sensor_msgs::CameraInfo left_, right_;
};

}  // namespace rotrocc
