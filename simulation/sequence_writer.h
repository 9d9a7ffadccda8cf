#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "simulation/simulator.h"

namespace rotrocc {

/// Writes a simulated drive in the layout of KittiSequence, with poses.txt; with truth also
///   depth/000000.tiff  32-bit float: depth [m] of each pixel of the left image; 0 for the sky
///   flow/000000.png    flow from that left image to the next in the format of KITTI's flow
///                      benchmark: 16 bit, red (u) and green (v) are 64 * flow [px] + 2^15, blue is
///                      1 where there is one. Flow of 512 px or more does not fit and is left out.
/// A depth is exact to 1e-7 of itself, a flow to 1/128 px. Calibration, times and poses are there
/// from the start, and an image appears when it is complete, the right one after the left one: so
/// others can follow while the drive is being rendered.
class SequenceWriter {
 public:
  /// Creates the directory. Throws std::runtime_error if that fails or if it already has images.
  SequenceWriter(const std::string& directory, const Simulator& simulator, bool with_truth);

  /// Call for each frame, in order. Throws std::runtime_error if the disk is full.
  void write(const SimulatedFrame& frame);

 private:
  std::string path(const char* folder, const char* extension) const;

  std::string directory_;
  bool with_truth_;
  int count_ = 0;
};

/// Writes a simulated drive of unrectified images in ASL format, see AslSequence, with the poses of
/// a body whose x axis looks forward. The first stamp is that of 2011-10-03.
class AslWriter {
 public:
  /// Creates the directory. Throws std::runtime_error if that fails or if it already has images.
  AslWriter(const std::string& directory, const UnrectifiedRig& rig, double baseline_m);

  /// A gyroscope in axes of the nominal left camera.
  void writeGyroscope(std::vector<GyroSample> samples);

  /// Call for each frame, in order. Throws std::runtime_error if the disk is full.
  void write(const SimulatedFrame& frame, const Eigen::Isometry3d& T_first_left);

 private:
  void writeImage(const std::string& camera,
                  std::ofstream& list,
                  std::int64_t stamp_ns,
                  const cv::Mat& image);

  std::string root_;
  std::ofstream left_list_;
  std::ofstream right_list_;
  std::ofstream poses_;
};

}  // namespace rotrocc
