#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <Eigen/Geometry>

#include "bags/stereo_bag.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Stereo pairs in the order of their stamps, wherever they are stored.
class StereoSource {
 public:
  virtual ~StereoSource() = default;

  /// Where the pairs are from, for messages.
  virtual std::string description() const = 0;

  /// Count of left images: there cannot be more pairs.
  virtual int size() const = 0;

  /// Reads the next pair and its camera. Returns false, and leaves them alone, when there is none.
  /// Throws std::runtime_error on images that cannot be read.
  virtual bool next(StereoPair& pair, StereoCamera& camera) = 0;

  /// Where the left camera is on the base: by the transforms of a bag, else KITTI's mount.
  virtual Eigen::Isometry3d mount(const std::string& base_frame) const = 0;

  /// What the stamps of the pairs need to be ROS's.
  virtual std::int64_t start_ns() const = 0;
};

/// Opens a sequence directory of the KITTI odometry benchmark, or a bag with `bag_options`.
/// Throws std::runtime_error if `path` is neither.
std::unique_ptr<StereoSource> openStereoSource(const std::string& path,
                                               const StereoBag::Options& bag_options);

}  // namespace rotrocc
