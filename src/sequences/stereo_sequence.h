#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "inertial/gyro_history.h"
#include "rectification/stereo_calibration.h"
#include "rotrocc/stereo_pair.h"
#include "rotrocc/trajectory.h"
#include "sequences/image_pairs.h"

namespace rotrocc {

struct GyroRecording {
  std::vector<GyroSample> samples;
  Eigen::Matrix3d R_camera_gyro = Eigen::Matrix3d::Identity();
};

/// A recording of stereo pairs as folders of images. The left camera is the rectified one in all
/// that follows: poses, mount, and axes of the gyroscope.
struct StereoSequence {
  std::string root;
  ImagePairs pairs;

  StereoCalibration calibration;  ///< of the images as they were recorded

  /// Poses of the left camera with the stamps of pairs; not of all pairs, if the truth is shorter.
  Trajectory ground_truth;
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();

  int size() const { return pairs.size(); }

  /// They increase.
  std::int64_t stamp_ns(int index) const { return pairs.stamp_ns(index); }

  /// The images of a pair as they were recorded, CV_8UC1 or CV_16UC1. Throws std::runtime_error if
  /// they are missing, unreadable or not of the size of the calibration.
  StereoPair read(int index) const;

  /// The gyroscope called `name`: a folder in ASL format with its pose on the base, or a CSV file
  /// in axes of the left camera. Empty: imu0 or imu.csv, or no samples if there is neither. Throws
  /// std::runtime_error if there is none of that name.
  GyroRecording gyroscope(const std::string& name) const;
};

struct SequenceOptions {
  double max_stamp_difference_s = 0.01;  ///< between the images of a pair
  double baseline_m = 0.0;               ///< 0: that of camera_calibration
  /// Files of readStereoCalibration(), in place of the sequence's own calibration; empty: none.
  std::vector<std::string> calibration = {};
  bool being_written = false;  ///< images may be missing yet, in KITTI's layout
};

/// Offset from the stamps of a sequence to ROS time: 0 if they are since 1970. If they begin with
/// the sequence, 2011-10-03, when KITTI recorded the first ones.
std::int64_t rosTimeOffset_ns(const StereoSequence& sequence);

/// Opens a directory in one of the layouts in layouts.h. Throws std::runtime_error that names the
/// file, the problem and a remedy if it is in none of them, or incomplete.
StereoSequence openStereoSequence(const std::string& directory, const SequenceOptions& options);

}  // namespace rotrocc
