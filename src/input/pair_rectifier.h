#pragma once

#include <memory>
#include <optional>

#include "rectification/stereo_rectifier.h"

namespace rotrocc {

/// Rectifies pairs by a calibration, with maps that are rebuilt only when it changes.
class PairRectifier {
 public:
  /// `threads`: of StereoRectifier.
  explicit PairRectifier(int threads = 2) : threads_(threads) {}

  void setThreads(int threads);

  /// `raw` has the size of the cameras. The rectified images are valid until the next call. Throws
  /// InputError if the images are too large for the maps.
  StereoPair rectify(const StereoPair& raw,
                     const std::shared_ptr<const StereoCalibration>& calibration);

 private:
  int threads_;
  std::optional<StereoRectifier> rectifier_;
  std::shared_ptr<const StereoCalibration> calibration_;  // that the maps are made of
};

}  // namespace rotrocc
