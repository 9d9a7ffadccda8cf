#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "inertial/gyro_sample.h"
#include "simulation/rendering/unrectified_rig.h"
#include "simulation/simulator.h"

namespace rotrocc {

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
