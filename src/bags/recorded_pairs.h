#pragma once

#include <cstdint>
#include <string>

#include <sensor_msgs/CameraInfo.h>

#include "bags/recording.h"
#include "input/camera_calibration.h"
#include "input/stereo_pair_converter.h"
#include "input/stereo_synchronizer.h"
#include "rectification/stereo_rectifier.h"
#include "rotrocc/parameters.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Which images are rectified by K, D, R and P of camera_info.
enum class Rectify {
  kIfRaw,  ///< those that have to be, see Recording::isRaw()
  kAlways,
  kNever,
};

/// The value of an option: auto, yes or no. Throws std::invalid_argument on any other text.
Rectify rectifyOption(const std::string& text);

/// The stereo pairs that the node makes of the messages of a recording, in the order in which they
/// are complete.
class RecordedPairs {
 public:
  /// `recording` must outlive this. Of `node` it takes what limits and matches images, and the
  /// baseline.
  explicit RecordedPairs(Recording& recording,
                         const NodeParameters& node = {},
                         Rectify rectify = Rectify::kIfRaw);
  RecordedPairs(const RecordedPairs&) = delete;
  RecordedPairs& operator=(const RecordedPairs&) = delete;

  /// Whether it rectifies the images.
  bool rectifies() const { return rectifies_; }

  /// Reads the next pair, with a stamp of the recording, and its camera. The images are valid until
  /// the next call. Returns false and leaves the arguments unchanged at the end. Throws
  /// std::runtime_error, with its stamp, on a pair that cannot be read or converted.
  bool next(StereoPair& pair, StereoCamera& camera);

  /// After the last pair: what had no partner; empty if nothing.
  std::string leftOut() const;

 private:
  bool add(const RecordedMessage& message);
  void convert(StereoPair& pair, StereoCamera& camera);

  Recording& recording_;
  StereoSynchronizer synchronizer_;
  StereoPairConverter converter_;
  double baseline_m_;
  sensor_msgs::CameraInfo::ConstPtr left_info_;
  sensor_msgs::CameraInfo::ConstPtr right_info_;
  StereoImages images_;
  bool rectifies_;
  CurrentCalibration calibration_;
  StereoRectifier rectifier_;
  int left_images_ = 0;
  int pairs_ = 0;
};

}  // namespace rotrocc
