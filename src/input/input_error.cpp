#include "input/input_error.h"

#include <iterator>

namespace rotrocc {
namespace {

/// In the order of DropReason.
const char* const kNames[] = {"image_size",
                              "image_encoding",
                              "image_step",
                              "image_data",
                              "image_sizes_differ",
                              "image_not_of_camera_info",
                              "camera_info_invalid",
                              "camera_info_missing",
                              "frame_id_missing",
                              "tf_missing",
                              "stamp_zero",
                              "stamp_repeated",
                              "stamp_backward",
                              "stamp_future",
                              "stamp_glitch",
                              "no_partner",
                              "partner_dropped",
                              "newer_pair_came",
                              "paused",
                              "failed"};
static_assert(std::size(kNames) == static_cast<std::size_t>(DropReason::kCount));

}  // namespace

const char* toString(DropReason reason) {
  return kNames[static_cast<std::size_t>(reason)];
}

}  // namespace rotrocc
