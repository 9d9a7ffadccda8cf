#include "input/silence_watch.h"

#include <algorithm>

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

SilenceWatch::SilenceWatch(double silence_s, Time now)
    : silence_limit_(silence_s), last_pair_(now), last_return_(now) {}

std::string SilenceWatch::onPair(std::int64_t stamp_ns, Time now) {
  const Duration silence = now - last_pair_;
  const bool may_tell = now - last_return_ >= kLeastDistance;
  std::string said;
  if (told_ || (isGap(silence) && may_tell)) {
    said = "stereo pairs arrive again, after " + seconds(silence);
  } else if (last_stamp_ns_ && silence < kLeastJump && may_tell &&
             toSeconds(stamp_ns - *last_stamp_ns_) > Duration(kLeastJump).count()) {
    said = "time jumped forward from " + stampText(*last_stamp_ns_) + " to " + stampText(stamp_ns) +
           " s: the odometry goes on at the last pose";
  }
  if (!said.empty()) last_return_ = now;
  last_stamp_ns_ = stamp_ns;
  told_ = false;
  last_pair_ = now;
  intervals_.push_back(silence);
  if (intervals_.size() > kIntervals) intervals_.pop_front();
  return said;
}

bool SilenceWatch::isGap(Duration silence) const {
  if (intervals_.size() < kIntervals || silence < kLeastGap) return false;
  std::deque<Duration> sorted = intervals_;
  const auto median = sorted.begin() + sorted.size() / 2;
  std::nth_element(sorted.begin(), median, sorted.end());
  return silence >= kUsualIntervals * *median;
}

std::string SilenceWatch::onTick(const InputReport& input, Time now) {
  if (input.clock_stands || now - last_pair_ < silence_limit_) return {};
  const std::string situation = situationOf(input);
  if (told_) {
    const bool is_news = situation != situation_;
    if (now - last_told_ < (is_news ? kLeastDistance : reminder_)) return {};
    if (!is_news) reminder_ = std::min(2 * reminder_, kLastReminder);
  } else {
    reminder_ = kFirstReminder;
  }
  told_ = true;
  last_told_ = now;
  situation_ = situation;
  const std::string why = whyNoPairs(input);
  return "no stereo pair for " + seconds(now - last_pair_) +
         ". Messages in the last 5 s: " + describeTopics(input) +
         (why.empty() ? "" : ". Likely: ") + why;
}

}  // namespace rotrocc
