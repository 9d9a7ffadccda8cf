#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <Eigen/Geometry>

#include "rectification/stereo_calibration.h"
#include "rotrocc/stereo_pair.h"
#include "rotrocc/trajectory.h"
#include "sequences/gyro_recording.h"
#include "sequences/image_pairs.h"

namespace rotrocc {

/// A recording of stereo pairs as folders of images. The left camera is the rectified one in all
/// that follows: poses, mount, and axes of the gyroscope.
class StereoSequence {
 public:
  /// What its layout tells.
  struct Parts {
    ImagePairs pairs;
    StereoCalibration calibration;
    Trajectory ground_truth;
    Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
    /// As gyroscope(), for a name that is not empty; throws if there is none.
    std::function<GyroRecording(const std::string& name)> gyroscope;
    std::string usual_gyroscope;  ///< the name if none is given; empty: there is none
  };

  StereoSequence(const std::string& directory, Parts parts);

  const std::string& directory() const { return directory_; }

  /// Number of pairs.
  int size() const { return parts_.pairs.size(); }

  /// Time of a pair; they increase.
  std::int64_t stamp_ns(int index) const { return parts_.pairs.stamp_ns(index); }

  /// Whether the images of a pair are there. They may not be yet if the sequence is being written.
  bool hasPair(int index) const { return parts_.pairs.hasFiles(index); }

  /// The images of a pair as they were recorded, CV_8UC1. Throws std::runtime_error if they are
  /// missing, unreadable or not of the size of the calibration.
  StereoPair read(int index);

  /// Of the images as they were recorded, and how to rectify them.
  const StereoCalibration& calibration() const { return parts_.calibration; }

  /// Poses of the left camera with the stamps of pairs; not of all pairs, if the truth is shorter.
  /// Empty if there is none.
  const Trajectory& groundTruth() const { return parts_.ground_truth; }

  const Eigen::Isometry3d& T_base_camera() const { return parts_.T_base_camera; }

  /// The gyroscope called `name`; empty: the one that the sequence has, or no samples if there is
  /// none. Throws std::runtime_error if there is none of that name.
  GyroRecording gyroscope(const std::string& name) const;

  /// What was left out, e.g. "3 left images and 1 right image without a partner"; empty if nothing.
  std::string leftOut() const { return parts_.pairs.leftOut(); }

 private:
  std::string directory_;
  Parts parts_;
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
