#include "input/drop_log.h"

#include "input/to_text.h"

namespace rotrocc {

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

std::uint64_t DropLog::total() const {
  std::uint64_t total = 0;
  for (const auto& [reason, count] : counts()) total += count;
  return total;
}

DropLog::Counts DropLog::counts() const {
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
