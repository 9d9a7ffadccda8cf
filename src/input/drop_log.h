#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "input/input_error.h"
#include "input/log.h"

namespace rotrocc {

/// Counts dropped input by reason and logs it: each reason at once, then more and more seldom,
/// an invalid camera_info once until there is a valid one. Thread-safe.
class DropLog {
 public:
  using Counts = std::map<DropReason, std::uint64_t>;

  explicit DropLog(Log log = Log()) : log_(std::move(log)) {}

  void add(const InputError& error);

  /// Counts without logging, for drops that are not a fault of the input.
  void count(DropReason reason, std::uint64_t count = 1);
  void set(DropReason reason, std::uint64_t count);

  /// All drops.
  std::uint64_t total() const;

  /// Of the reasons that have occurred.
  Counts counts() const;

  /// The last drop, if it is not older than `age`.
  std::optional<InputError> lastWithin(std::chrono::duration<double> age) const;

  /// A valid camera_info: the next invalid one is logged again, even if it is the same.
  void forgetCameraError();

 private:
  void log(const InputError& error);

  Log log_;
  mutable std::mutex mutex_;
  Counts counts_;
  std::map<DropReason, Throttle> throttles_;
  Throttle camera_throttle_{std::chrono::seconds(1)};
  std::string camera_error_;
  std::optional<InputError> last_;
  std::chrono::steady_clock::time_point last_time_;
};

}  // namespace rotrocc
