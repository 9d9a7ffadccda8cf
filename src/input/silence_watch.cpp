#include "input/silence_watch.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/median.h"
#include "common/to_seconds.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

constexpr std::chrono::seconds kLeastDistance(5);
/// A gap is as long as this, and as so many of the usual intervals.
constexpr std::chrono::seconds kLeastGap(1);
constexpr double kUsualIntervals = 4.0;
constexpr std::size_t kIntervals = 16;
/// Of the stamps, within less time.
constexpr std::chrono::seconds kLeastJump(1);
/// A slow odometry in lockstep holds the clock for less.
constexpr std::chrono::milliseconds kStandstill(1500);

/// "3.1 s", "35 s"
std::string seconds(std::chrono::duration<double> duration) {
  return fixedText(duration.count(), duration.count() < 9.95 ? 1 : 0) + " s";
}

/// The parts that cause a new report when they change; without numbers, which always change.
std::string situationOf(const InputReport& input) {
  std::string situation;
  for (const TopicReport* topic : input.topics()) {
    situation += topic->publishers > 0 ? 'p' : '-';
    situation += topic->recent > 0 ? 'm' : '-';
  }
  situation += input.clock_missing ? 'c' : '-';
  situation += input.waits_for_info ? 'w' : '-';
  situation += input.rejected.empty() ? '-' : 'r';
  return situation + input.camera_error;
}

}  // namespace

SilenceWatch::SilenceWatch(double no_input_warning_s, Time now, Log log)
    : log_(std::move(log)),
      silence_limit_(no_input_warning_s),
      last_pair_(now),
      last_warning_(now) {}

void SilenceWatch::onPair(std::int64_t stamp_ns,
                          double stamp_age_s,
                          std::uint64_t dropped,
                          Time now) {
  const Duration silence = now - last_pair_;
  const std::string again = "stereo pairs arrive again, after " + seconds(silence);
  if (std::exchange(logged_, false)) {
    log_.info(again);
  } else if (now - last_warning_ >= kLeastDistance) {
    const bool is_gap = isGap(silence, dropped - dropped_);
    if (is_gap || isJump(stamp_ns, stamp_age_s, silence)) {
      last_warning_ = now;
      log_.warn(is_gap ? again
                       : "time jumped forward from " + stampText(*last_stamp_ns_) + " to " +
                             stampText(stamp_ns) + " s: the odometry continues from the last pose");
    }
  }
  last_stamp_ns_ = stamp_ns;
  last_stamp_age_s_ = stamp_age_s;
  dropped_ = dropped;
  last_pair_ = now;
  intervals_.push_back(silence);
  if (intervals_.size() > kIntervals) intervals_.pop_front();
}

/// One that drops do not explain.
bool SilenceWatch::isGap(Duration silence, std::uint64_t dropped) const {
  if (intervals_.size() < kIntervals || silence < kLeastGap) return false;
  std::vector<Duration> intervals(intervals_.begin(), intervals_.end());
  const double usual_intervals = silence / median(intervals);
  return usual_intervals >= kUsualIntervals &&
         2.0 * static_cast<double>(dropped) < usual_intervals - 1.0;
}

/// Whether stamps and clock jumped forward by more than the time that passed.
bool SilenceWatch::isJump(std::int64_t stamp_ns, double stamp_age_s, Duration silence) const {
  if (!last_stamp_ns_ || silence >= kLeastJump) return false;
  const Duration step(toSeconds(stamp_ns - *last_stamp_ns_));
  const Duration ahead_of_clock(last_stamp_age_s_ - stamp_age_s);
  return step > kLeastJump && 2.0 * ahead_of_clock < step;
}

void SilenceWatch::onTick(InputReport& input, const Arrival& now) {
  if (now.clock_ns != clock_moved_.clock_ns) clock_moved_ = now;
  input.clock_stands = now.clock_ns != 0 && now.time - clock_moved_.time >= kStandstill;
  const Duration silence = now.time - last_pair_;
  if (input.clock_stands || silence < silence_limit_) return;
  const std::string situation = situationOf(input);
  const bool is_news = !logged_ || situation != situation_;
  if (logged_ && is_news && now.time - last_logged_ < kLeastDistance) return;
  if (is_news) reminder_ = Throttle();
  if (!reminder_.pass(now.time)) return;
  logged_ = true;
  last_logged_ = now.time;
  situation_ = situation;
  const auto why = whyNoPairs(input);
  log_.warn("no stereo pair for " + seconds(silence) + ". Messages in the last 5 s: " +
            describeTopics(input) + (why ? ". Likely: " + *why : ""));
}

}  // namespace rotrocc
