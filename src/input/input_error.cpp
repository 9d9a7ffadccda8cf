#include "input/input_error.h"

#include <iterator>

#include "input/to_text.h"

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

std::uint64_t totalOf(const DropCounts& counts) {
  std::uint64_t total = 0;
  for (const auto& [reason, count] : counts) total += count;
  return total;
}

void DropLog::add(const InputError& error) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++counts_[error.reason()];
  log(error);
  last_ = error;
  last_time_ = std::chrono::steady_clock::now();
}

void DropLog::log(const InputError& error) {
  if (error.reason() == DropReason::kCameraInfoInvalid) {
    if (camera_error_ == error.what() || !camera_throttle_.pass()) return;
    camera_error_ = error.what();
    log_.error(std::string("no calibration: ") + error.what());
    return;
  }
  if (!throttles_[error.reason()].pass()) return;
  log_.warn(std::string("dropped (") + toString(error.reason()) + ", " +
            toText(counts_[error.reason()]) + " so far): " + error.what());
}

void DropLog::count(DropReason reason, std::uint64_t count) {
  const std::lock_guard<std::mutex> lock(mutex_);
  counts_[reason] += count;
}

void DropLog::set(DropReason reason, std::uint64_t count) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (count > 0) counts_[reason] = count;
}

DropCounts DropLog::counts() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counts_;
}

std::optional<InputError> DropLog::lastWithin(std::chrono::duration<double> age) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (last_ && std::chrono::steady_clock::now() - last_time_ > age) return std::nullopt;
  return last_;
}

void DropLog::forgetCameraError() {
  const std::lock_guard<std::mutex> lock(mutex_);
  camera_error_.clear();
}

}  // namespace rotrocc
