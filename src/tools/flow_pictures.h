#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "rotrocc/flow_picture.h"
#include "rotrocc/stereo_pair.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// Writes the flow picture of each pair to a folder: 000000.png, 000001.png and so on.
class FlowPictures {
 public:
  /// Creates the folder. Throws std::runtime_error if that fails.
  FlowPictures(const std::string& folder, FlowView view);

  /// Draws the last call of odometry.process(), with input `pair` and `camera` and output `result`.
  /// Throws std::runtime_error if the file cannot be written.
  void write(const StereoPair& pair,
             const StereoCamera& camera,
             const VisualOdometry& odometry,
             const OdometryResult& result);

 private:
  std::string folder_;
  FlowView view_;
  int pairs_ = 0;
  cv::Mat picture_;
};

}  // namespace rotrocc
