#include "input/input_report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Below this skew, the cameras are assumed to be synchronized.
constexpr double kPlausibleSkew_s = 0.05;
/// In periods. With more, jitter makes neighbours the nearest ones.
constexpr double kLargeSkew = 0.25;
constexpr double kLargestSkew = 0.5;
/// Images without a partner that are worth a warning, if they are a tenth of all.
constexpr std::size_t kLeastLost = 5;
/// Older images are late for any use; drivers and networks take less.
constexpr double kOld_s = 1.0;
/// Further ahead than simulated time between two messages on /clock.
constexpr double kAhead_s = 0.2;
/// Clocks that differ by more are not those of one robot.
constexpr double kOtherClock_s = 3600.0;
/// A topic is silent after this, and after so many of its periods.
constexpr double kSilent_s = 1.0;
constexpr double kSilentPeriods = 3.0;

std::string milliseconds(double seconds) {
  std::ostringstream text;
  text << std::setprecision(3) << 1e3 * seconds << " ms";
  return text.str();
}

std::string describe(const TopicReport& topic) {
  return topic.topic + ' ' + std::to_string(topic.recent) +
         (topic.rate_hz > 0.0 ? " (" + fixedText(topic.rate_hz, 1) + " Hz)" : "");
}

bool isSilent(const TopicReport& topic) {
  if (topic.recent == 0) return true;
  const double period_s = topic.rate_hz > 0.0 ? 1.0 / topic.rate_hz : 0.0;
  return topic.silent_s && *topic.silent_s > std::max(kSilent_s, kSilentPeriods * period_s);
}

std::string whySilent(const TopicReport& topic) {
  if (topic.publishers == 0 && topic.total > 0) {
    return "nobody publishes " + topic.topic +
           " any more: has the bag ended or the driver stopped?";
  }
  if (topic.publishers == 0) {
    return "nobody publishes " + topic.topic +
           ": start the driver, or remap it to the right topic (see rostopic list)";
  }
  if (topic.recent > 0) {
    return topic.topic + " has been silent for " + fixedText(*topic.silent_s, 1) +
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
  return std::to_string(std::lround(100.0 * std::abs(skew_s) / period_s)) + " % of the period of " +
         milliseconds(period_s);
}

std::string skewOfAPeriodText(const InputReport& report) {
  const double skew_s = *report.skew_of_a_period_s;
  return "right stamps are " + milliseconds(std::abs(skew_s)) +
         (skew_s > 0.0 ? " after" : " before") +
         " the left ones with the same jitter, about a period, so images of different times have "
         "the nearest stamps: correct the stamps of the drivers";
}

std::string whyUnmatched(const InputReport& report) {
  const double difference_s = *report.stamp_difference_s;
  const std::string apart =
      "left and right stamps are up to " + milliseconds(difference_s) + " apart, more than ";
  if (isLarge(difference_s, report)) {
    return apart + milliseconds(report.tolerance_s) + " and " +
           ofPeriod(difference_s, *report.period_s) +
           ": trigger the cameras synchronously; with a larger max_stamp_difference_s, images of "
           "different times would be pairs";
  }
  const std::string too_far =
      apart + "max_stamp_difference_s = " + milliseconds(report.max_stamp_difference_s);
  if (difference_s <= kPlausibleSkew_s) {
    const double enough_s = std::ceil(1.2e3 * difference_s) * 1e-3;
    return too_far + ": trigger the cameras synchronously, or set max_stamp_difference_s to " +
           toText(enough_s);
  }
  return too_far +
         ": are both topics from the same rig, and the clocks of both drivers synchronized?";
}

std::string whyLost(const InputReport& report) {
  const auto& [left, right, pairs] = report.unmatched;
  const std::size_t lost = std::max(left, right);
  const std::size_t images = pairs + lost;
  if (lost < kLeastLost || 10 * lost < images) return "";
  const std::size_t missing = lost - std::min(left, right);
  const TopicReport& fewer = left > right ? report.right_image : report.left_image;
  return std::to_string(100 * lost / images) +
         " % of the images have no partner: " + report.left_image.topic + " arrives at " +
         fixedText(report.left_image.rate_hz, 1) + " Hz, " + report.right_image.topic + " at " +
         fixedText(report.right_image.rate_hz, 1) + " Hz" +
         (2 * missing > lost ? ": the camera of " + fewer.topic + " or its connection loses images"
                             : ": both lose images, or stamps are more than " +
                                   milliseconds(report.tolerance_s) + " apart");
}

/// Empty if the age is usual, or the clock is another one.
std::string ageText(const InputReport& report) {
  const double age_s = report.stamp_age_s.value_or(0.0);
  if (isOfAnotherClock(report) || (age_s < kOld_s && age_s > -kAhead_s)) return "";
  const std::string stamps =
      "the stamps of " + report.left_image.topic + " are " + fixedText(std::abs(age_s), 1) + " s ";
  if (age_s < 0.0) {
    return stamps +
           "ahead of the clock, and so are odometry and tf, which others cannot use yet: "
           "synchronise the clocks of camera and computer";
  }
  return stamps +
         "behind the clock when the images arrive: synchronise the clocks of camera and "
         "computer, or if the images are late, find out what delays them; a bag is to be "
         "played with --clock and use_sim_time";
}

}  // namespace

std::string describeTopics(const InputReport& report) {
  std::string text;
  for (const TopicReport* topic :
       {&report.left_image, &report.right_image, &report.left_info, &report.right_info}) {
    text += (text.empty() ? "" : ", ") + describe(*topic);
  }
  if (report.stamp_difference_s) {
    text +=
        "; stamps of left and right differ by at most " + milliseconds(*report.stamp_difference_s);
  }
  return text;
}

std::string whyNoPairs(const InputReport& report) {
  if (report.clock_missing) {
    return "use_sim_time is true, but there is no message on /clock: play the bag with --clock, or "
           "set "
           "use_sim_time to false";
  }
  if (report.clock_stands) return "/clock stands still: the replay is paused or has ended";
  if (const std::string silent = whySilent(report); !silent.empty()) return silent;
  if (!report.camera_error.empty()) return report.camera_error;
  for (const TopicReport* info : {&report.left_info, &report.right_info}) {
    if (report.waits_for_info && info->total == 0) return whySilent(*info);
  }
  if (report.recent_pairs == 0 && report.skew_of_a_period_s) return skewOfAPeriodText(report);
  if (report.stamp_difference_s && report.recent_pairs == 0 &&
      *report.stamp_difference_s > report.tolerance_s) {
    return whyUnmatched(report);
  }
  return report.refused;
}

std::string whySilent(const InputReport& report) {
  for (const TopicReport* image : {&report.left_image, &report.right_image}) {
    if (isSilent(*image)) return whySilent(*image);
  }
  return "";
}

std::string faultOfPairs(const InputReport& report) {
  if (report.recent_pairs == 0) return "";
  if (report.skew_of_a_period_s) return skewOfAPeriodText(report);
  if (report.median_skew_s && isLarge(*report.median_skew_s, report)) {
    return "left and right stamps are " + milliseconds(std::abs(*report.median_skew_s)) +
           " apart, " + ofPeriod(*report.median_skew_s, *report.period_s) +
           ", so it is not sure which images are of one time: trigger the cameras synchronously";
  }
  const std::string lost = whyLost(report);
  return lost.empty() ? ageText(report) : lost;
}

bool isOfAnotherClock(const InputReport& report) {
  return std::abs(report.stamp_age_s.value_or(0.0)) > kOtherClock_s;
}

}  // namespace rotrocc
