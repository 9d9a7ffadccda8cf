#include "input/input_error.h"

namespace rotrocc {

const char* toString(DropReason reason) {
  switch (reason) {
    case DropReason::kImageSize:
      return "image_size";
    case DropReason::kImageEncoding:
      return "image_encoding";
    case DropReason::kImageStep:
      return "image_step";
    case DropReason::kImageData:
      return "image_data";
    case DropReason::kImageSizesDiffer:
      return "image_sizes_differ";
    case DropReason::kImageNotOfCamera:
      return "image_not_of_camera_info";
    case DropReason::kCameraInfoInvalid:
      return "camera_info_invalid";
    case DropReason::kCameraInfoMissing:
      return "camera_info_missing";
    case DropReason::kFrameMissing:
      return "frame_id_missing";
    case DropReason::kTfMissing:
      return "tf_missing";
    case DropReason::kStampZero:
      return "stamp_zero";
    case DropReason::kStampRepeated:
      return "stamp_repeated";
    case DropReason::kStampBackward:
      return "stamp_backward";
    case DropReason::kStampFuture:
      return "stamp_future";
    case DropReason::kStampGlitch:
      return "stamp_glitch";
    case DropReason::kNoPartner:
      return "no_partner";
    case DropReason::kSuperseded:
      return "newer_pair_came";
    case DropReason::kPaused:
      return "paused";
    case DropReason::kFailed:
    case DropReason::kCount:
      break;
  }
  return "failed";
}

std::vector<std::pair<DropReason, std::uint64_t>> DropCounters::nonZero() const {
  std::vector<std::pair<DropReason, std::uint64_t>> drops;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (const std::uint64_t count = counts_[i]) {
      drops.emplace_back(static_cast<DropReason>(i), count);
    }
  }
  return drops;
}

}  // namespace rotrocc
