#include "input/stamp_guard.h"

#include "input/input_error.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Images of one camera are not reordered by more.
constexpr std::int64_t kMaxReordering_ns = 1'000'000'000;
constexpr int kBackwardInARow = 3;

double seconds(std::int64_t ns) {
  return 1e-9 * static_cast<double>(ns);
}

}  // namespace

StampGuard::StampGuard(const std::string& topic, double max_future_s)
    : topic_(topic), max_future_s_(max_future_s) {}

void StampGuard::check(std::int64_t stamp_ns, std::int64_t clock_ns) {
  clock_went_back_ = clock_went_back_ || clock_ns < last_clock_ns_;
  last_clock_ns_ = clock_ns;
  if (stamp_ns == 0) {
    throw InputError(DropReason::kStampZero,
                     topic_ + " has the stamp 0: set header.stamp in the driver");
  }
  checkClock(stamp_ns, clock_ns);
  if (last_stamp_ns_ == stamp_ns) {
    throw InputError(DropReason::kStampRepeated,
                     topic_ + " has the same stamp as the previous one, " + stampText(stamp_ns) +
                         " s: are there two drivers, or does one send each image twice?");
  }
  if (last_stamp_ns_ && stamp_ns < *last_stamp_ns_ && !beginsAnew(stamp_ns)) {
    throw InputError(DropReason::kStampBackward,
                     topic_ + " has the stamp " + stampText(stamp_ns) + " s, " +
                         toText(seconds(*last_stamp_ns_ - stamp_ns)) +
                         " s before the previous one: send images in the order of their stamps");
  }
  last_stamp_ns_ = stamp_ns;
  last_backward_ns_.reset();
  backward_in_a_row_ = 0;
  clock_went_back_ = false;
}

void StampGuard::checkClock(std::int64_t stamp_ns, std::int64_t clock_ns) const {
  const double ahead_s = seconds(stamp_ns - clock_ns);
  if (clock_ns == 0 || ahead_s <= max_future_s_) return;
  throw InputError(DropReason::kStampFuture,
                   topic_ + " has the stamp " + stampText(stamp_ns) + " s, " + toText(ahead_s) +
                       " s ahead of the clock: synchronise the clocks of the machines, or raise "
                       "max_future_s = " +
                       toText(max_future_s_));
}

bool StampGuard::beginsAnew(std::int64_t stamp_ns) {
  const bool in_order = !last_backward_ns_ || stamp_ns > *last_backward_ns_;
  last_backward_ns_ = stamp_ns;
  backward_in_a_row_ = in_order ? backward_in_a_row_ + 1 : 1;
  return clock_went_back_ || *last_stamp_ns_ - stamp_ns >= kMaxReordering_ns ||
         backward_in_a_row_ >= kBackwardInARow;
}

}  // namespace rotrocc
