#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "features/image_pyramid.h"

namespace rotrocc {

/// The images of one stereo pair as the tracker needs them. Level 0 of the pyramids is a copy of
/// the image.
struct StereoFrame {
  std::int64_t stamp_ns = 0;
  ImagePyramid left, right;
};

/// A frame is shared by those that need it: as the last one, as a lost one, as a keyframe.
using FramePtr = std::shared_ptr<const StereoFrame>;

inline double secondsBetween(const StereoFrame& earlier, const StereoFrame& later) {
  return 1e-9 * static_cast<double>(later.stamp_ns - earlier.stamp_ns);
}

/// Frames whose memory is reused once nobody holds them.
class FramePool {
 public:
  std::shared_ptr<StereoFrame> acquire();

 private:
  std::vector<std::shared_ptr<StereoFrame>> frames_;
};

}  // namespace rotrocc
