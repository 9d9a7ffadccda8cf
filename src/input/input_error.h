#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "input/log.h"

namespace rotrocc {

/// Why received input is dropped.
enum class DropReason {
  kImageSize,          ///< an image is empty, too small, too large, or not of the size of the mask
  kImageEncoding,      ///< unknown encoding
  kImageStep,          ///< rows shorter than their pixels
  kImageData,          ///< less data than the header says, or damaged
  kImageSizesDiffer,   ///< left and right differ
  kImageNotOfCamera,   ///< the images are not of the size in camera_info
  kCameraInfoInvalid,  ///< camera_info is not a rectified stereo camera
  kCameraInfoMissing,  ///< no valid camera_info for a pair
  kFrameMissing,       ///< no frame_id in the left image
  kTfMissing,          ///< no camera pose in tf for a pair
  kStampZero,
  kStampRepeated,   ///< same as the previous image
  kStampBackward,   ///< slightly earlier than the previous image
  kStampGlitch,     ///< far from the images before and after
  kNoPartner,       ///< no image of the other side within max_stamp_difference_s
  kPartnerDropped,  ///< the image of the other side was dropped for its stamp
  kSuperseded,      ///< a newer pair came while the estimator was busy
  kPaused,
  kFailed,  ///< internal error
  kCount
};

/// Name in status and diagnostics: "image_size", "no_partner", ...
const char* toString(DropReason reason);

/// Invalid input; what() is one sentence with the value and a remedy.
class InputError : public std::invalid_argument {
 public:
  InputError(DropReason reason, const std::string& what)
      : std::invalid_argument(what), reason_(reason) {}
  DropReason reason() const { return reason_; }

 private:
  DropReason reason_;
};

using DropCounts = std::map<DropReason, std::uint64_t>;

/// The number of drops of all reasons.
std::uint64_t totalOf(const DropCounts& counts);

/// Counts dropped input by reason and logs it: each reason at once, then at growing intervals,
/// an invalid camera_info once until there is a valid one. Thread-safe.
class DropLog {
 public:
  explicit DropLog(Log log = Log()) : log_(std::move(log)) {}

  void add(const InputError& error);

  /// Counts without logging, for drops that are not a fault of the input.
  void count(DropReason reason, std::uint64_t count = 1);
  void set(DropReason reason, std::uint64_t count);

  /// Of the reasons that have occurred.
  DropCounts counts() const;

  /// The last drop, if it is not older than `age`.
  std::optional<InputError> lastWithin(std::chrono::duration<double> age) const;

  /// A valid camera_info: the next invalid one is logged again, even if it is the same.
  void forgetCameraError();

 private:
  void log(const InputError& error);

  Log log_;
  mutable std::mutex mutex_;
  DropCounts counts_;
  std::map<DropReason, Throttle> throttles_;
  Throttle camera_throttle_{std::chrono::seconds(1)};
  std::string camera_error_;
  std::optional<InputError> last_;
  std::chrono::steady_clock::time_point last_time_;
};

}  // namespace rotrocc
