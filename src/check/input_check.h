#pragma once

#include <cstdint>
#include <map>
#include <string>

#include <sensor_msgs/CameraInfo.h>

#include "bags/recording.h"
#include "check/rig_report.h"
#include "input/stamps.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Rates, gaps, stamps and camera_info of the messages of a recording.
class InputCheck {
 public:
  void observe(const RecordedMessage& message);

  /// `left_out`: see RecordedPairs::leftOut(). `rectifies`: whether the images are rectified here.
  void report(const StereoCamera& camera,
              const std::string& left_out,
              bool rectifies,
              RigReport& report) const;

  /// What is known without a pair that can be used. `max_apart_s`: see max_stamp_difference_s.
  void reportStreams(double max_apart_s, RigReport& report) const;

 private:
  void addStamps(double max_apart_s, RigReport& report) const;

  Stamps left_ns_, right_ns_;
  std::map<std::int64_t, double> ages_s_;        // of left images, by stamp
  sensor_msgs::CameraInfo::ConstPtr left_info_;  // the last one
};

}  // namespace rotrocc
