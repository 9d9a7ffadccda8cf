#pragma once

#include <fstream>
#include <string>

#include "rotrocc/trajectory.h"
#include "simulation/simulator.h"

namespace rotrocc {

/// Writes a simulated drive in the layout of KittiSequence, with poses.txt; with truth also
///   depth/000000.tiff  32-bit float: depth [m] of each pixel of the left image; 0 for the sky
///   flow/000000.png    flow from that left image to the next in the format of KITTI's flow
///                      benchmark: 16 bit, red (u) and green (v) are 64 * flow [px] + 2^15, blue is
///                      1 where there is one. Flow of 512 px or more does not fit and is left out.
/// A depth is exact to 1e-7 of itself, a flow to 1/128 px.
class SequenceWriter {
 public:
  /// Creates the directory. Throws std::runtime_error if that fails or if it already has images.
  SequenceWriter(const std::string& directory, const StereoCamera& camera, bool with_truth);

  /// Call for each frame, in order. Throws std::runtime_error if the disk is full.
  void write(const SimulatedFrame& frame, const Eigen::Isometry3d& T_first_left);

 private:
  std::string path(const char* folder, const char* extension) const;

  std::string directory_;
  bool with_truth_;
  int count_ = 0;
  std::ofstream times_;
  TrajectoryWriter poses_;
};

}  // namespace rotrocc
