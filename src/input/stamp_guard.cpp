#include "input/stamp_guard.h"

#include <algorithm>
#include <cstdlib>

#include "common/to_seconds.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Images of one camera are not reordered by more.
constexpr std::int64_t kMaxReordering_ns = 1'000'000'000;
constexpr int kBackwardInARow = 3;
/// A loop starts at the first image, or at one of the first if some are lost.
constexpr std::int64_t kStartOfLoop_ns = 1'000'000'000;
/// Images that arrive late are less ahead of the clock: the highest of so many is that of images
/// in time.
constexpr std::size_t kArrivals = 16;
/// In periods. After a glitch of less, the following images are not late enough for a jump back.
constexpr std::int64_t kTolerance = 3;
constexpr std::int64_t kUnknownTolerance_ns = 1'000'000'000;

}  // namespace

StampGuard::StampGuard(const std::string& topic, double max_future_s)
    : topic_(topic), max_future_s_(max_future_s) {}

StampGuard::Verdict StampGuard::check(std::int64_t stamp_ns, std::int64_t clock_ns) {
  const Arrival arrival = {stamp_ns, clock_ns};
  clock_went_back_ = clock_went_back_ || clock_ns < last_clock_ns_;
  last_clock_ns_ = clock_ns;
  if (stamp_ns == 0) {
    throw InputError(DropReason::kStampZero,
                     topic_ + " has the stamp 0: set header.stamp in the driver");
  }
  checkClock(arrival);
  if (last_stamp_ns_ == stamp_ns || (held_ && held_->stamp_ns == stamp_ns)) {
    throw InputError(DropReason::kStampRepeated,
                     topic_ + " has the same stamp as the previous one, " + stampText(stamp_ns) +
                         " s: are there two drivers, or does one send each image twice?");
  }

  Verdict verdict;
  if (continues(arrival)) {
    if (held_) verdict.glitch = glitchOf(*held_);
    held_.reset();
    accept(arrival);
  } else if (held_ && stamp_ns > held_->stamp_ns &&
             arrival.ahead_ns() - held_->ahead_ns() <= tolerance_ns()) {
    verdict.held_is_valid = true;
    if (held_->stamp_ns < *last_stamp_ns_) restart();
    accept(*held_);
    held_.reset();
    accept(arrival);
  } else {
    if (held_) verdict.glitch = glitchOf(*held_);
    held_ = arrival;
    verdict.held = true;
  }
  return verdict;
}

std::optional<double> StampGuard::age_s() const {
  if (ahead_ns_.empty() || last_clock_ns_ == 0) return std::nullopt;
  const double age_s = toSeconds(-usualAhead_ns());
  if (age_s < -max_future_s_) return std::nullopt;  // of one that arrived before the first /clock
  return age_s;
}

std::int64_t StampGuard::usualAhead_ns() const {
  return *std::max_element(ahead_ns_.begin(), ahead_ns_.end());
}

void StampGuard::checkClock(const Arrival& arrival) const {
  const double ahead_s = toSeconds(arrival.ahead_ns());
  if (arrival.clock_ns == 0 || ahead_s <= max_future_s_) return;
  throw InputError(DropReason::kStampFuture,
                   topic_ + " has the stamp " + stampText(arrival.stamp_ns) + " s, " +
                       toText(ahead_s) +
                       " s ahead of the clock: synchronise the clocks of the machines");
}

/// Whether a stamp is credible without another one like it.
bool StampGuard::continues(const Arrival& arrival) {
  if (!last_stamp_ns_) return true;
  if (arrival.stamp_ns < *last_stamp_ns_) return goesBack(arrival);
  return arrival.ahead_ns() - usualAhead_ns() <= tolerance_ns();
}

/// Whether a stamp earlier than the last one is credible. Throws if it is out of order.
bool StampGuard::goesBack(const Arrival& arrival) {
  const std::int64_t back_ns = *last_stamp_ns_ - arrival.stamp_ns;
  bool credible = clock_went_back_;
  if (back_ns >= kMaxReordering_ns) {
    credible = credible || arrival.stamp_ns <= *first_stamp_ns_ + kStartOfLoop_ns;
  } else {
    const bool in_order = !last_backward_ns_ || arrival.stamp_ns > *last_backward_ns_;
    last_backward_ns_ = arrival.stamp_ns;
    backward_in_a_row_ = in_order ? backward_in_a_row_ + 1 : 1;
    credible = credible || backward_in_a_row_ >= kBackwardInARow;
    if (!credible) {
      throw InputError(DropReason::kStampBackward,
                       topic_ + " has the stamp " + stampText(arrival.stamp_ns) + " s, " +
                           toText(toSeconds(back_ns)) +
                           " s before the previous one: send images in the order of their stamps");
    }
  }
  if (credible) restart();
  return credible;
}

/// How much further ahead of the clock a stamp may be than those before it.
std::int64_t StampGuard::tolerance_ns() const {
  const auto period_ns = series_.period_ns();
  return period_ns ? kTolerance * *period_ns : kUnknownTolerance_ns;
}

InputError StampGuard::glitchOf(const Arrival& held) const {
  const std::int64_t off_ns = held.stamp_ns - *last_stamp_ns_;
  return InputError(DropReason::kStampGlitch,
                    topic_ + " had the stamp " + stampText(held.stamp_ns) + " s, " +
                        toText(1e-3 * static_cast<double>(std::abs(off_ns) / 1'000'000)) +
                        (off_ns > 0 ? " s after" : " s before") +
                        " the previous one, but the next one did not follow it: a glitch; check "
                        "where the driver takes header.stamp from");
}

void StampGuard::accept(const Arrival& arrival) {
  if (!first_stamp_ns_) first_stamp_ns_ = arrival.stamp_ns;
  last_stamp_ns_ = arrival.stamp_ns;
  last_backward_ns_.reset();
  backward_in_a_row_ = 0;
  clock_went_back_ = false;
  series_.add(arrival.stamp_ns);
  ahead_ns_.push_back(arrival.ahead_ns());
  if (ahead_ns_.size() > kArrivals) ahead_ns_.pop_front();
}

void StampGuard::restart() {
  first_stamp_ns_.reset();
  ahead_ns_.clear();
}

}  // namespace rotrocc
