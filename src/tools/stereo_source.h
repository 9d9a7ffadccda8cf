#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <Eigen/Geometry>

#include "bags/stereo_bag.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"
#include "sequences/gyro_recording.h"

namespace rotrocc {

/// Source of stereo pairs, in the order of their stamps.
class StereoSource {
 public:
  virtual ~StereoSource() = default;

  /// Name of the source, for messages.
  virtual std::string description() const = 0;

  /// An upper bound of the number of pairs.
  virtual int size() const = 0;

  /// Reads the next pair and its camera. Returns false and leaves the arguments unchanged at the
  /// end. Throws std::runtime_error on images that cannot be read.
  virtual bool next(StereoPair& pair, StereoCamera& camera) = 0;

  /// Pose of the left camera on the base: from the tf of a bag, or of a sequence.
  virtual Eigen::Isometry3d mount(const std::string& base_frame) const = 0;

  /// The gyroscope of a topic of a bag, with its mount from tf, or of a sequence. Throws
  /// std::runtime_error if there is none of that name.
  virtual GyroRecording gyroscope(const std::string& name, const std::string& base_frame) const = 0;

  /// Offset from the stamps of the pairs to ROS time.
  virtual std::int64_t start_ns() const = 0;

  /// After the last pair: what had no partner; empty if nothing.
  virtual std::string leftOut() const = 0;
};

/// Opens a sequence, see openStereoSequence(), or a bag with `bag_options`. Throws
/// std::runtime_error if `path` is neither.
std::unique_ptr<StereoSource> openStereoSource(const std::string& path,
                                               const StereoBag::Options& bag_options);

}  // namespace rotrocc
