#include "input/silence_watch.h"

#include <algorithm>
#include <utility>

#include "common/to_seconds.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

constexpr std::chrono::seconds kLeastDistance(5);
constexpr std::chrono::seconds kFirstReminder(10);
constexpr std::chrono::seconds kLastReminder(60);
/// A gap is as long as this, and as so many of the usual intervals.
constexpr std::chrono::seconds kLeastGap(1);
constexpr double kUsualIntervals = 4.0;
constexpr std::size_t kIntervals = 16;
/// Of the stamps, within less time.
constexpr std::chrono::seconds kLeastJump(1);

/// "3.1 s", "35 s"
std::string seconds(std::chrono::duration<double> duration) {
  return fixedText(duration.count(), duration.count() < 9.95 ? 1 : 0) + " s";
}

/// The parts that cause a new report when they change; without numbers, which always change.
std::string situationOf(const InputReport& input) {
  std::string situation;
  for (const TopicReport* topic :
       {&input.left_image, &input.right_image, &input.left_info, &input.right_info}) {
    situation += topic->publishers > 0 ? 'p' : '-';
    situation += topic->recent > 0 ? 'm' : '-';
  }
  situation += input.clock_missing ? 'c' : '-';
  situation += input.waits_for_info ? 'w' : '-';
  situation += input.refused.empty() ? '-' : 'r';
  return situation + input.camera_error;
}

}  // namespace

SilenceWatch::SilenceWatch(double silence_s, Time now, Log log)
    : log_(std::move(log)), silence_limit_(silence_s), last_pair_(now), last_warning_(now) {}

void SilenceWatch::onPair(const Pair& pair, std::uint64_t dropped, Time now) {
  const Duration gap = silence(now);
  const auto again = [&] { return "stereo pairs arrive again, after " + seconds(gap); };
  if (std::exchange(told_, false)) {
    log_.info(again());
  } else if (now - last_warning_ >= kLeastDistance) {
    const bool is_gap = isGap(gap, dropped - dropped_);
    if (is_gap || isJump(pair, gap)) {
      last_warning_ = now;
      log_.warn(is_gap
                    ? again()
                    : "time jumped forward from " + stampText(last_->stamp_ns) + " to " +
                          stampText(pair.stamp_ns) + " s: the odometry goes on at the last pose");
    }
  }
  last_ = pair;
  dropped_ = dropped;
  last_pair_ = now;
  intervals_.push_back(gap);
  if (intervals_.size() > kIntervals) intervals_.pop_front();
}

/// One that drops do not explain.
bool SilenceWatch::isGap(Duration silence, std::uint64_t dropped) const {
  if (intervals_.size() < kIntervals || silence < kLeastGap) return false;
  std::deque<Duration> sorted = intervals_;
  const auto median = sorted.begin() + sorted.size() / 2;
  std::nth_element(sorted.begin(), median, sorted.end());
  const double missing = silence / *median - 1.0;
  return silence >= kUsualIntervals * *median && 2.0 * static_cast<double>(dropped) < missing;
}

/// Whether stamps and clock jumped forward by more than the time that passed.
bool SilenceWatch::isJump(const Pair& pair, Duration passed) const {
  if (!last_ || passed >= kLeastJump) return false;
  const Duration step(toSeconds(pair.stamp_ns - last_->stamp_ns));
  const Duration ahead_of_clock(last_->stamp_age_s - pair.stamp_age_s);
  return step > kLeastJump && 2.0 * ahead_of_clock < step;
}

void SilenceWatch::onTick(const InputReport& input, Time now) {
  if (input.clock_stands || silence(now) < silence_limit_) return;
  const std::string situation = situationOf(input);
  if (told_) {
    const bool is_news = situation != situation_;
    if (now - last_told_ < (is_news ? kLeastDistance : reminder_)) return;
    if (!is_news) reminder_ = std::min(2 * reminder_, kLastReminder);
  } else {
    reminder_ = kFirstReminder;
  }
  told_ = true;
  last_told_ = now;
  situation_ = situation;
  const std::string why = whyNoPairs(input);
  log_.warn("no stereo pair for " + seconds(silence(now)) + ". Messages in the last 5 s: " +
            describeTopics(input) + (why.empty() ? "" : ". Likely: ") + why);
}

}  // namespace rotrocc
