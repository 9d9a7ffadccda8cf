#pragma once

#include <array>
#include <string>
#include <vector>

#include "simulation/simulator.h"

namespace rotrocc {

/// Writes samples in the layout of data.csv of the EuRoC data set, with accelerations of zero.
/// Throws std::runtime_error if the file cannot be written.
void writeGyroscope(const std::string& path, const std::vector<GyroSample>& samples);

/// Writes a simulated drive. If its images are rectified, in the layout of KITTI with
/// poses.txt, else in ASL format, see AslSequence, with the poses of a body whose x axis looks
/// forward and stamps from 2011-10-03 on. All but the images is there from the start, and an image
/// appears when it is complete, the right one after the left one: so others can follow while the
/// drive is being rendered.
class SequenceWriter {
 public:
  struct Extras {
    bool depth = false;  ///< of rectified left images [m], depth/000000.tiff, float; 0: sky
    bool imu = false;    ///< a gyroscope: imu.csv in axes of the left camera, or imu0 in ASL format
  };

  /// Creates the directory. Throws std::runtime_error if that fails or if it already has images.
  SequenceWriter(const std::string& directory, const Simulator& simulator, const Extras& extras);

  /// Call for each frame, in order. Throws std::runtime_error if the disk is full.
  void write(const SimulatedFrame& frame);

 private:
  void startKitti(const Simulator& simulator, bool with_imu);
  void startAsl(const Simulator& simulator, bool with_imu);

  std::string directory_;
  bool with_depth_;
  std::vector<std::array<std::string, 2>> images_;  // paths of the left and right one of each frame
  std::size_t count_ = 0;
};

}  // namespace rotrocc
