#include "input/input_report.h"

#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>

#include "input/camera_clock.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Below this skew, the cameras are assumed to be synchronized.
constexpr double kPlausibleSkew_s = 0.05;
/// In periods. With more, jitter makes neighbors the nearest ones.
constexpr double kLargeSkew = 0.25;
constexpr double kLargestSkew = 0.5;
/// Images without a partner that are worth a warning, if they are a tenth of all.
constexpr std::size_t kLeastLost = 5;
/// Older images are late for any use; drivers and networks take less.
constexpr double kOld_s = 1.0;
/// Further ahead than simulated time between two messages on /clock.
constexpr double kAhead_s = 0.2;
/// A topic is silent after this, and after so many of its periods.
constexpr double kSilent_s = 1.0;
constexpr double kSilentPeriods = 3.0;

std::string milliseconds(double seconds) {
  return cv::format("%.3g ms", 1e3 * seconds);
}

std::string rateText(const TopicReport& topic) {
  return fixedText(topic.rate_hz, 1) + " Hz";
}

std::optional<std::string> whySilent(const TopicReport& topic) {
  const double period_s = topic.rate_hz > 0.0 ? 1.0 / topic.rate_hz : 0.0;
  const double silent_s = topic.silent_s.value_or(0.0);
  if (topic.recent > 0 && silent_s <= std::max(kSilent_s, kSilentPeriods * period_s)) return {};
  if (topic.publishers == 0) {
    return "nobody publishes " + topic.topic +
           (topic.total > 0
                ? " any more: has the bag ended or the driver stopped?"
                : ": start the driver, or remap it to the right topic (see rostopic list)");
  }
  if (topic.recent > 0) {
    return topic.topic + " has been silent for " + fixedText(silent_s, 1) +
           " s: has the driver or the connection stopped?";
  }
  return topic.topic +
         " has a publisher, but no messages arrive: is the driver running, and the "
         "network configured (ROS_IP, ROS_HOSTNAME)?";
}

bool isLarge(double skew_s, const InputReport& report) {
  if (!report.period_s) return false;
  const double periods = std::abs(skew_s) / *report.period_s;
  return periods > kLargeSkew && periods <= kLargestSkew;
}

std::string ofPeriod(double skew_s, double period_s) {
  return toText(std::lround(100.0 * std::abs(skew_s) / period_s)) + " % of the period of " +
         milliseconds(period_s);
}

std::string skewOfAPeriodText(double skew_s) {
  return "right stamps are " + milliseconds(std::abs(skew_s)) +
         (skew_s > 0.0 ? " after" : " before") +
         " the left ones with the same jitter, about a period, so images of different times have "
         "the nearest stamps: correct the stamps of the drivers";
}

std::string whyUnmatched(const InputReport& report) {
  const double difference_s = report.skew->largest_s;
  const std::string apart =
      "left and right stamps are up to " + milliseconds(difference_s) + " apart, more than ";
  if (isLarge(difference_s, report)) {
    return apart + milliseconds(report.tolerance_s) + " and " +
           ofPeriod(difference_s, *report.period_s) +
           ": trigger the cameras synchronously; with a larger max_stamp_difference_s, images of "
           "different times would be pairs";
  }
  return apart + "max_stamp_difference_s = " + milliseconds(report.max_stamp_difference_s) +
         (difference_s <= kPlausibleSkew_s
              ? ": trigger the cameras synchronously, or set max_stamp_difference_s to " +
                    toText(std::ceil(1.2e3 * difference_s) * 1e-3)
              : ": are both topics from the same rig, and the clocks of both drivers "
                "synchronized?");
}

/// Share of the period by which stamps may scatter.
constexpr double kLargeScatter = 0.1;

std::optional<std::string> whyLost(const InputReport& report) {
  const auto& [left, right, pairs] = report.unmatched;
  const std::size_t lost = std::max(left, right);
  const std::size_t images = pairs + lost;
  if (lost < kLeastLost || 10 * lost < images) return {};
  const bool is_of_one_side = 2 * std::min(left, right) < lost;
  const TopicReport& fewer = left > right ? report.right_image : report.left_image;
  return toText(100 * lost / images) +
         " % of the images have no partner: " + report.left_image.topic + " arrives at " +
         rateText(report.left_image) + ", " + report.right_image.topic + " at " +
         rateText(report.right_image) +
         (is_of_one_side ? ": the camera of " + fewer.topic + " or its connection loses images"
                         : ": both lose images, or stamps are more than " +
                               milliseconds(report.tolerance_s) + " apart");
}

/// None if the age is usual, or that of a replay.
std::optional<std::string> whyAge(const InputReport& report) {
  const double age_s = report.stamp_age_s.value_or(0.0);
  const bool is_replay = isOfAnotherClock(report) && age_s > 0.0;
  if (is_replay || (age_s < kOld_s && age_s > -kAhead_s)) return {};
  const std::string stamps =
      "the stamps of " + report.left_image.topic + " are " + fixedText(std::abs(age_s), 1) + " s ";
  return stamps + (age_s < 0.0
                       ? "ahead of the clock, so other nodes cannot use odometry and tf yet: "
                         "synchronize the clocks of camera and computer"
                       : "behind the clock on arrival: synchronize the clocks of camera and "
                         "computer, or if the images are late, find out what delays them; play "
                         "bags with --clock and use_sim_time");
}

}  // namespace

std::string describeTopics(const InputReport& report) {
  std::string text;
  for (const TopicReport* topic : report.topics()) {
    text += (text.empty() ? "" : ", ") + topic->topic + ' ' + toText(topic->recent) +
            (topic->rate_hz > 0.0 ? " (" + rateText(*topic) + ")" : "");
  }
  if (!report.skew) return text;
  return text + "; stamps of left and right differ by at most " +
         milliseconds(report.skew->largest_s);
}

std::optional<std::string> whyNoPairs(const InputReport& report) {
  if (report.clock_missing) {
    return "use_sim_time is true, but there is no message on /clock: play the bag with --clock, or "
           "set use_sim_time to false";
  }
  if (report.clock_stands) return "/clock stands still: the replay is paused or has ended";
  if (const auto silent = whySilent(report)) return silent;
  if (!report.camera_error.empty()) return report.camera_error;
  for (const TopicReport* info : {&report.left_info, &report.right_info}) {
    if (report.waits_for_info && info->total == 0) return whySilent(*info);
  }
  if (report.recent_pairs == 0 && report.skew) {
    if (report.skew->of_a_period_s) return skewOfAPeriodText(*report.skew->of_a_period_s);
    if (report.skew->largest_s > report.tolerance_s) return whyUnmatched(report);
  }
  if (report.rejected.empty()) return {};
  return report.rejected;
}

std::optional<std::string> whySilent(const InputReport& report) {
  const auto left = whySilent(report.left_image);
  return left ? left : whySilent(report.right_image);
}

std::optional<std::string> faultOfPairs(const InputReport& report) {
  if (report.recent_pairs == 0) return {};
  if (report.skew && report.skew->of_a_period_s) {
    return skewOfAPeriodText(*report.skew->of_a_period_s);
  }
  const double skew_s = report.skew ? report.skew->median_s.value_or(0.0) : 0.0;
  if (isLarge(skew_s, report)) {
    return "left and right stamps are " + milliseconds(std::abs(skew_s)) + " apart, " +
           ofPeriod(skew_s, *report.period_s) +
           ", so images may be paired wrongly: trigger the cameras synchronously";
  }
  if (const auto lost = whyLost(report)) return lost;
  if (report.period_s && report.stamp_scatter_s > kLargeScatter * *report.period_s) {
    return "the stamps of " + report.left_image.topic + " scatter by " +
           milliseconds(report.stamp_scatter_s) + ", " +
           ofPeriod(report.stamp_scatter_s, *report.period_s) +
           ", and velocities with them: stamp images when they are exposed, not when they arrive";
  }
  return whyAge(report);
}

bool isOfAnotherClock(const InputReport& report) {
  return std::abs(report.stamp_age_s.value_or(0.0)) > kOtherClock_s;
}

}  // namespace rotrocc
