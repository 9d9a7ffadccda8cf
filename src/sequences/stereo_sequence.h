#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <Eigen/Geometry>

#include "rectification/stereo_calibration.h"
#include "rotrocc/stereo_pair.h"
#include "rotrocc/trajectory.h"
#include "sequences/gyro_recording.h"

namespace rotrocc {

/// A recording of stereo pairs as folders of images. The left camera is the rectified one in all
/// that follows: poses, mount, and axes of the gyroscope.
class StereoSequence {
 public:
  virtual ~StereoSequence() = default;

  virtual const std::string& directory() const = 0;

  /// Number of pairs.
  virtual int size() const = 0;

  /// Time of a pair; they increase.
  virtual std::int64_t stamp_ns(int index) const = 0;

  /// Whether the images of a pair are there. They may not be yet if the sequence is being written.
  virtual bool hasPair(int /*index*/) const { return true; }

  /// The images of a pair as they were recorded, CV_8UC1. Throws std::runtime_error if they are
  /// missing, unreadable or not of the size of the calibration.
  virtual StereoPair read(int index) = 0;

  /// Of the images as they were recorded, and how to rectify them.
  virtual const StereoCalibration& calibration() const = 0;

  /// Poses of the left camera with the stamps of pairs; not of all pairs, if the truth is shorter.
  /// Empty if there is none.
  virtual const Trajectory& groundTruth() const = 0;

  virtual Eigen::Isometry3d T_base_camera() const = 0;

  /// The gyroscope called `name`; empty: the one that the sequence has, or no samples if there is
  /// none. Throws std::runtime_error if there is none of that name.
  virtual GyroRecording gyroscope(const std::string& name) const = 0;

  /// What was left out, e.g. "3 left images and 1 right image without a partner"; empty if nothing.
  virtual std::string leftOut() const = 0;
};

struct SequenceOptions {
  double max_stamp_difference_s = 0.01;  ///< between the images of a pair
  double baseline_m = 0.0;               ///< 0: that of camera_calibration
  bool being_written = false;            ///< images may be missing yet, in KITTI's layout
};

/// Offset from the stamps of a sequence to ROS time: 0 if they are since 1970, and kKittiStart_s if
/// they begin with the sequence.
std::int64_t rosTimeOffset_ns(const StereoSequence& sequence);

/// Opens a directory with
///   image_0, image_1, calib.txt, times.txt    a sequence of the KITTI odometry benchmark
///   mav0/cam0, mav0/cam1                      a recording in ASL format, as those of EuRoC
///   left, right, left.yaml, right.yaml        images with files of camera_calibration
/// Throws std::runtime_error that names the file, the problem and a remedy if it is none of them,
/// or incomplete.
std::unique_ptr<StereoSequence> openStereoSequence(const std::string& directory,
                                                   const SequenceOptions& options);

}  // namespace rotrocc
