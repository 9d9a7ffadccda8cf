#pragma once

#include <stdexcept>
#include <string>

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
  kStampFuture,     ///< too far ahead of the clock
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

}  // namespace rotrocc
