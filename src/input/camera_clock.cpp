#include "input/camera_clock.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include "common/median.h"
#include "common/to_seconds.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

constexpr std::size_t kLatest = 32;
/// No latency puts a stamp ahead of the clock, and clocks that are synchronized at all differ by
/// less. One published stamp of the future makes tf listeners ignore all later ones.
constexpr double kMaxFuture_s = 10.0;
/// In periods: images of one camera are not reordered by more.
constexpr double kMaxReordering = 10.0;
constexpr int kBackwardInARow = 3;
/// In periods: a loop starts at the first image, or at one of the first if some are lost.
constexpr double kStartOfLoop = 10.0;
/// Images that arrive late are less ahead of the clock: the highest of so many is that of images
/// in time.
constexpr std::size_t kArrivals = 16;
/// In periods. After a glitch of less, the following images are not late enough for a jump back.
constexpr double kTolerance = 3.0;
/// In periods: a fast replay that loses images looks like a smaller step.
constexpr double kLeastStep = 10.0;
/// While it is unknown: that of a slow camera.
constexpr std::int64_t kUnknownPeriod_ns = 300'000'000;

/// Standard deviation, robust against outliers.
double scatter(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const double center = median(values);
  for (double& value : values) value = std::abs(value - center);
  return kDeviationOverMedian * median(values);
}

}  // namespace

CameraClock::Verdict CameraClock::judge(std::int64_t stamp_ns, const Arrival& arrival) {
  const Image image = {stamp_ns, arrival};
  arrival_went_back_ = arrival_went_back_ || arrival.ns() < last_arrival_ns_;
  last_arrival_ns_ = arrival.ns();
  if (stamp_ns == 0) {
    throw InputError(DropReason::kStampZero,
                     images_ + " has the stamp 0: set header.stamp in the driver");
  }
  if (lastStamp_ns() == stamp_ns || (held_ && held_->stamp_ns == stamp_ns)) {
    throw InputError(DropReason::kStampRepeated,
                     images_ + " has the same stamp as the previous one, " + stampText(stamp_ns) +
                         " s: are there two drivers, or does one send each image twice?");
  }

  Verdict verdict;
  const bool continued = continues(image);
  verdict.held_is_valid = !continued && held_ && stamp_ns > held_->stamp_ns &&
                          image.ahead_ns() - held_->ahead_ns() <= periods_ns(kTolerance);
  verdict.held = !continued && !verdict.held_is_valid;
  if (held_ && !verdict.held_is_valid) {
    const std::int64_t off_ns =
        latest_.empty() ? held_->ahead_ns() : held_->stamp_ns - *lastStamp_ns();
    verdict.glitch = InputError(
        DropReason::kStampGlitch,
        images_ + " had the stamp " + stampText(held_->stamp_ns) + " s, " +
            toText(1e-3 * static_cast<double>(std::abs(off_ns) / 1'000'000)) +
            (off_ns > 0 ? " s after" : " s before") +
            (latest_.empty() ? " the clock" : " the previous one") +
            ", but the next one did not follow it: a glitch; check where the driver takes "
            "header.stamp from");
  }
  if (continued) held_.reset();
  if (verdict.held) held_ = image;
  return verdict;
}

/// Whether a stamp is credible without another one like it.
bool CameraClock::continues(const Image& image) {
  if (latest_.empty()) {
    return image.arrival.clock_ns == 0 || toSeconds(image.ahead_ns()) <= kMaxFuture_s;
  }
  if (image.stamp_ns < *lastStamp_ns()) return goesBack(image);
  return image.ahead_ns() - usualAhead_ns() <= periods_ns(kTolerance);
}

/// Whether a stamp earlier than the last one is credible. Throws if it is out of order.
bool CameraClock::goesBack(const Image& image) {
  const std::int64_t back_ns = *lastStamp_ns() - image.stamp_ns;
  if (arrival_went_back_) return true;
  if (back_ns >= periods_ns(kMaxReordering)) {
    return isStartOfLoop(image.stamp_ns);
  }
  if (++backward_in_a_row_ >= kBackwardInARow) return true;
  throw InputError(DropReason::kStampBackward,
                   images_ + " has the stamp " + stampText(image.stamp_ns) + " s, " +
                       toText(toSeconds(back_ns)) +
                       " s before the previous one: send images in the order of their stamps");
}

bool CameraClock::isStartOfLoop(std::int64_t stamp_ns) const {
  return stamp_ns - *first_stamp_ns_ <= periods_ns(kStartOfLoop);
}

/// By how much the clock was set before the image.
std::int64_t CameraClock::stepTo(const Image& image) const {
  const std::int64_t ahead_ns = image.ahead_ns() - usualAhead_ns();
  const std::int64_t waited_ns = image.arrival.ns() - latest_.back().arrival.ns();
  if (static_cast<double>(waited_ns) > periods_ns(kLeastStep)) return 0;  // a pause: another drive
  if (arrival_went_back_) return 0;  // ROS time was set, or a bag starts again
  const std::int64_t stamp_step_ns = image.stamp_ns - *lastStamp_ns();
  if (stamp_step_ns < 0) return isStartOfLoop(image.stamp_ns) ? 0 : ahead_ns;
  return std::min(ahead_ns, stamp_step_ns) > periods_ns(kLeastStep) ? ahead_ns : 0;
}

std::int64_t CameraClock::usualAhead_ns() const {
  std::int64_t ahead_ns = latest_.back().ahead_ns();
  for (std::size_t i = 2; i <= std::min(latest_.size(), kArrivals); ++i) {
    ahead_ns = std::max(ahead_ns, latest_[latest_.size() - i].ahead_ns());
  }
  return ahead_ns;
}

double CameraClock::periods_ns(double count) const {
  return count * static_cast<double>(period_ns_.value_or(kUnknownPeriod_ns));
}

void CameraClock::add(std::int64_t stamp_ns, const Arrival& arrival) {
  Image image = {stamp_ns, arrival};
  if (held_ && held_->stamp_ns == stamp_ns) image = *std::exchange(held_, std::nullopt);
  const auto knows_clock = [](const Image& one) { return one.arrival.clock_ns != 0; };
  const bool is_comparable = !latest_.empty() && knows_clock(latest_.back()) == knows_clock(image);
  if (is_comparable) set_ns_ += stepTo(image);
  const bool goes_back = lastStamp_ns() && stamp_ns < *lastStamp_ns();
  if (goes_back || !first_stamp_ns_) first_stamp_ns_ = stamp_ns;
  if (goes_back || !is_comparable) latest_.clear();
  image.set_ns = set_ns_;
  latest_.push_back(image);
  if (latest_.size() > kLatest) latest_.pop_front();
  if (const auto period_ns = periodOf(stamps_ns())) period_ns_ = period_ns;
  arrival_went_back_ = false;
  backward_in_a_row_ = 0;
}

std::int64_t CameraClock::setAt_ns(std::int64_t stamp_ns) const {
  const auto found = std::find_if(latest_.begin(), latest_.end(), [&](const Image& image) {
    return image.stamp_ns == stamp_ns;
  });
  return found == latest_.end() ? set_ns_ : found->set_ns;
}

std::optional<std::int64_t> CameraClock::lastStamp_ns() const {
  if (latest_.empty()) return std::nullopt;
  return latest_.back().stamp_ns;
}

Stamps CameraClock::stamps_ns() const {
  Stamps stamps_ns;
  for (const Image& image : latest_) stamps_ns.push_back(image.stamp_ns);
  return stamps_ns;
}

std::optional<double> CameraClock::age_s() const {
  if (latest_.empty() || latest_.back().arrival.clock_ns == 0) return std::nullopt;
  return toSeconds(-usualAhead_ns());
}

double CameraClock::stampScatter_s() const {
  std::vector<double> errors_s;
  for (std::size_t i = 1; i < latest_.size(); ++i) {
    const double step_s = toSeconds(latest_[i].stamp_ns - latest_[i - 1].stamp_ns);
    errors_s.push_back(std::remainder(step_s, toSeconds(*period_ns_)));
  }
  return std::sqrt(0.5) * scatter(errors_s);  // a step has the errors of two stamps
}

double CameraClock::arrivalScatter_s() const {
  std::vector<double> delays_s;
  for (const Image& image : latest_) delays_s.push_back(toSeconds(-image.ahead_ns()));
  return scatter(delays_s);
}

}  // namespace rotrocc
