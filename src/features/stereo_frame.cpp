#include "features/stereo_frame.h"

namespace rotrocc {

std::shared_ptr<StereoFrame> FramePool::acquire() {
  for (const auto& frame : frames_) {
    if (frame.use_count() == 1) return frame;
  }
  frames_.push_back(std::make_shared<StereoFrame>());
  return frames_.back();
}

}  // namespace rotrocc
