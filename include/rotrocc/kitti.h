#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "rotrocc/stereo_camera.h"
#include "rotrocc/trajectory.h"

namespace rotrocc {

/// A sequence in the layout of the KITTI odometry benchmark:
///   image_0/000000.png ...  rectified left grey images
///   image_1/000000.png ...  rectified right grey images
///   calib.txt               the 3x4 projection matrices `P0:` (left) and `P1:` (right), row by row
///   times.txt               one time [s] per line
///   poses.txt               ground truth, one pose of the left camera per line, or in TUM format
///                           with stamps around all times; optional
class KittiSequence {
 public:
  /// Reads everything except the images. Throws std::runtime_error that names file and problem if a
  /// file is missing or unreadable, numbers of images, times and poses differ, times do not
  /// increase, or P0 and P1 are not rectified. Of a sequence that is being written, only the first
  /// left image needs to be there.
  explicit KittiSequence(const std::string& directory, bool being_written = false);

  const std::string& directory() const { return directory_; }

  /// Number of stereo pairs.
  int size() const { return static_cast<int>(stamps_ns_.size()); }

  /// Width and height are those of the first left image.
  const StereoCamera& camera() const { return camera_; }

  /// Time of pair `index`, in [0, size()). Throws std::out_of_range for any other index.
  std::int64_t stamp_ns(int index) const { return stamps_ns_.at(index); }

  /// The images of pair `index` as CV_8UC1. Both throw std::runtime_error with the file's path if
  /// it is missing, unreadable or not of the camera's size.
  cv::Mat readLeft(int index) const { return read(leftPath(index)); }
  cv::Mat readRight(int index) const { return read(rightPath(index)); }

  /// The files of pair `index`. The right one is written after the left one.
  std::string leftPath(int index) const { return imagePath("image_0", index); }
  std::string rightPath(int index) const { return imagePath("image_1", index); }

  /// size() poses of the left camera, with the stamps of the pairs. Empty if there is no poses.txt.
  const Trajectory& groundTruth() const { return ground_truth_; }

 private:
  std::string imagePath(const char* folder, int index) const;
  cv::Mat read(const std::string& path) const;

  std::string directory_;
  StereoCamera camera_;
  std::vector<std::int64_t> stamps_ns_;
  Trajectory ground_truth_;
};

}  // namespace rotrocc
