#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "bags/recording.h"
#include "input/input_error.h"
#include "input/stereo_intake.h"
#include "input/stereo_pair_converter.h"
#include "rectification/stereo_calibration.h"
#include "rotrocc/parameters.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// The stereo pairs that the node makes of the messages of a recording, in the order in which they
/// are complete. Images that cannot be used, and those with a wrong stamp, are dropped as in the
/// node, and logged.
class RecordedPairs {
 public:
  /// `recording` must outlive this. `rectify`: whether images are rectified by camera_info: yes,
  /// no, or auto, see Recording::isRaw(). `calibration`: they are rectified by it instead. Throws
  /// std::invalid_argument on any other text, and std::runtime_error if the mask cannot be read.
  explicit RecordedPairs(Recording& recording,
                         const NodeParameters& node = {},
                         const std::string& rectify = "auto",
                         std::shared_ptr<const StereoCalibration> calibration = nullptr);

  /// Passes each message that is read from now on, before it is used.
  void onMessage(std::function<void(const RecordedMessage&)> observe) {
    observe_ = std::move(observe);
  }

  bool rectifies() const { return rectifies_; }

  /// Reads the next pair, with a stamp of the recording. The images are valid until the next call.
  /// Stamps go back where time jumps back. Returns false and leaves the arguments unchanged at the
  /// end. Throws std::runtime_error if the recording is unreadable, or has no pair that can be
  /// used.
  bool next(StereoPair& pair, StereoCamera& camera);

  /// Of the pair that next() has returned.
  StereoCalibration calibration() const {
    return current_.calibration ? *current_.calibration : rectifiedCalibration(current_.camera);
  }

  /// After the last pair: how many there could have been but are not, and why; empty if none.
  std::string leftOut() const;

 private:
  bool readMessage();
  void add(const RecordedMessage& message);

  Recording& recording_;
  std::function<void(const RecordedMessage&)> observe_ = [](const RecordedMessage&) {};
  std::shared_ptr<const StereoCalibration> calibration_;
  bool rectifies_;
  DropLog drops_;
  StereoIntake intake_;
  std::deque<ReceivedPair> received_;
  ReceivedPair current_;  // of the last call of next()
  StereoPairConverter converter_;
  int pairs_ = 0;
};

}  // namespace rotrocc
