#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <Eigen/Geometry>

#include "bags/stereo_bag.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"
#include "tools/recorded_gyro.h"

namespace rotrocc {

/// Source of stereo pairs, in the order of their stamps.
class StereoSource {
 public:
  virtual ~StereoSource() = default;

  /// Name of the source, for messages.
  virtual std::string description() const = 0;

  /// Number of left images: an upper bound of the number of pairs.
  virtual int size() const = 0;

  /// Reads the next pair and its camera. Returns false and leaves the arguments unchanged at the
  /// end. Throws std::runtime_error on images that cannot be read.
  virtual bool next(StereoPair& pair, StereoCamera& camera) = 0;

  /// Pose of the left camera on the base: from the tf of a bag, otherwise KITTI's.
  virtual Eigen::Isometry3d mount(const std::string& base_frame) const = 0;

  /// The gyroscope of a topic of a bag, with its mount from tf. Throws std::runtime_error if there
  /// is none.
  virtual GyroRecording gyroscope(const std::string& topic,
                                  const std::string& base_frame) const = 0;

  /// Offset from the stamps of the pairs to ROS time.
  virtual std::int64_t start_ns() const = 0;
};

/// Opens a sequence directory of the KITTI odometry benchmark, or a bag with `bag_options`.
/// Throws std::runtime_error if `path` is neither.
std::unique_ptr<StereoSource> openStereoSource(const std::string& path,
                                               const StereoBag::Options& bag_options);

}  // namespace rotrocc
