#include "input/input_report.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <sstream>

namespace rotrocc {
namespace {

/// Below this skew, the cameras are assumed to be synchronized.
constexpr double kPlausibleSkew_s = 0.05;

std::string milliseconds(double seconds) {
  std::ostringstream text;
  text << std::setprecision(3) << 1e3 * seconds << " ms";
  return text.str();
}

std::string describe(const TopicReport& topic) {
  std::ostringstream text;
  text << topic.topic << ' ' << topic.recent;
  if (topic.rate_hz > 0.0) {
    text << " (" << std::fixed << std::setprecision(1) << topic.rate_hz << " Hz)";
  }
  return text.str();
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
  return topic.topic +
         " has a publisher, but no messages arrive: is the driver running, and the "
         "network configured (ROS_IP, ROS_HOSTNAME)?";
}

std::string whyUnmatched(double difference_s, double limit_s) {
  const std::string apart = "left and right stamps are up to " + milliseconds(difference_s) +
                            " apart, more than max_stamp_difference_s = " + milliseconds(limit_s);
  if (difference_s <= kPlausibleSkew_s) {
    const double enough_s = std::ceil(1.2e3 * difference_s) * 1e-3;
    std::ostringstream advice;
    advice << ": trigger the cameras synchronously, or set max_stamp_difference_s to " << enough_s;
    return apart + advice.str();
  }
  return apart +
         ": are both topics from the same rig, and the clocks of both drivers synchronized?";
}

}  // namespace

std::optional<double> greatestStampDifference(const std::deque<std::int64_t>& left_ns,
                                              const std::deque<std::int64_t>& right_ns) {
  if (left_ns.empty() || right_ns.empty()) return std::nullopt;
  const auto [oldest, newest] = std::minmax_element(right_ns.begin(), right_ns.end());
  std::int64_t nearest_of_all_ns = INT64_MAX;
  std::int64_t greatest_ns = -1;
  for (const std::int64_t left : left_ns) {
    std::int64_t nearest_ns = INT64_MAX;
    for (const std::int64_t right : right_ns) {
      nearest_ns = std::min(nearest_ns, std::abs(left - right));
    }
    nearest_of_all_ns = std::min(nearest_of_all_ns, nearest_ns);
    // The partner of a stamp beyond the ends may be beyond them as well.
    if (left >= *oldest && left <= *newest) greatest_ns = std::max(greatest_ns, nearest_ns);
  }
  return 1e-9 * static_cast<double>(greatest_ns >= 0 ? greatest_ns : nearest_of_all_ns);
}

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
  for (const TopicReport* image : {&report.left_image, &report.right_image}) {
    if (image->recent == 0) return whySilent(*image);
  }
  if (!report.camera_error.empty()) return report.camera_error;
  for (const TopicReport* info : {&report.left_info, &report.right_info}) {
    if (report.waits_for_info && info->total == 0) return whySilent(*info);
  }
  if (report.stamp_difference_s && report.recent_pairs == 0 &&
      *report.stamp_difference_s > report.max_stamp_difference_s) {
    return whyUnmatched(*report.stamp_difference_s, report.max_stamp_difference_s);
  }
  return report.refused;
}

}  // namespace rotrocc
