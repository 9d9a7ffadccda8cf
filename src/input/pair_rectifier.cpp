#include "input/pair_rectifier.h"

#include <stdexcept>

#include "input/input_error.h"

namespace rotrocc {

void PairRectifier::setThreads(int threads) {
  if (threads == threads_) return;
  threads_ = threads;
  if (rectifier_) rectifier_->setThreads(threads);
}

StereoPair PairRectifier::rectify(const StereoPair& raw,
                                  const std::shared_ptr<const StereoCalibration>& calibration) {
  if (!rectifier_ || calibration != calibration_) {
    try {
      rectifier_.emplace(*calibration, threads_);
    } catch (const std::invalid_argument& error) {
      throw InputError(DropReason::kCameraInfoInvalid, error.what());
    }
    calibration_ = calibration;
  }
  return rectifier_->rectify(raw);
}

}  // namespace rotrocc
