#include "node/health/diagnostics.h"

#include <algorithm>
#include <cmath>

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <ros/init.h>

#include "node/health/hundredths.h"
#include "rotrocc/OdometryStatus.h"

namespace rotrocc {
namespace {

using diagnostic_msgs::DiagnosticStatus;

/// Latencies vary with the load of the machine: warn only if most pairs are late.
constexpr double kLateShareOfPeriod = 1.0;
/// Rigs are rarely better calibrated; the correction is right on average only, and leaves more of a
/// larger bias.
constexpr double kLargeBias_px = 0.5;
/// More than a good rectification leaves, and more than the matching of small windows tolerates.
constexpr double kRowsApart_px = 0.5;
/// At 10 m/s, or at half a radian per second, a pixel or so of disparity error.
constexpr double kNotableSkew_s = 0.002;
constexpr double kSkewSigmas = 4.0;

unsigned char levelOf(std::uint8_t state) {
  switch (state) {
    case OdometryStatus::OK:
    case OdometryStatus::INITIALISING:
      return DiagnosticStatus::OK;
    case OdometryStatus::DEGRADED:
    case OdometryStatus::PAUSED:
      return DiagnosticStatus::WARN;
    default:
      return DiagnosticStatus::ERROR;
  }
}

void addTopic(const TopicReport& topic, StatusWrapper& status) {
  status.addf(topic.topic,
              "%.1f Hz, %zu in 5 s, %llu in total, %zu publishers",
              topic.rate_hz,
              topic.recent,
              static_cast<unsigned long long>(topic.total),
              topic.publishers);
}

/// Empty unless the skew is notable and beyond doubt.
std::string skewWarning(const TimeSkew& skew) {
  const double least_s = std::max(kNotableSkew_s, kSkewSigmas * skew.sigma_s);
  if (skew.sigma_s == 0.0 || std::abs(skew.estimated_s) < least_s) return "";
  return "the right images are taken " + hundredths(1e3 * std::abs(skew.estimated_s)) + " ms (+- " +
         hundredths(1e3 * skew.sigma_s) + ") " + (skew.estimated_s > 0.0 ? "after" : "before") +
         " the left ones: trigger both cameras by one signal";
}

}  // namespace

std::string rigWarning(const OdometryResult& result) {
  const DisparityBias& bias = result.disparity_bias;
  const RowOffset& rows = result.row_offset;
  std::string what;
  if (std::abs(bias.applied_px) >= kLargeBias_px) {
    what = "disparities have a bias of " + hundredths(-bias.estimated_px) + " px (+- " +
           hundredths(bias.sigma_px) + "), which is corrected";
  }
  if (rows.typical_px >= kRowsApart_px) {
    what += (what.empty() ? "" : "; ") + std::string("rows of left and right differ by ") +
            hundredths(rows.typical_px) + " px, with a median offset of " +
            hundredths(rows.median_px) + " px (+- " + hundredths(rows.sigma_px) + ")" +
            (rows.applied_px != 0.0 ? ", which is corrected" : "");
  }
  if (!what.empty()) what += ": recalibrate the stereo rig";
  const std::string skew = skewWarning(result.time_skew);
  return what.empty() || skew.empty() ? what + skew : what + "; " + skew;
}

void describeOdometry(const HealthReport& report, StatusWrapper& status) {
  const NodeState state = stateOf(report);
  const std::string name = stateName(state.state);
  status.summary(levelOf(state.state), state.reason.empty() ? name : name + ": " + state.reason);
  if (!report.hint.empty()) status.mergeSummary(DiagnosticStatus::WARN, report.hint);
  if (const std::string rig = rigWarning(report.last_result); !rig.empty()) {
    status.mergeSummary(DiagnosticStatus::WARN, rig);
  }
  const StageCounts& counts = report.last_result.counts;
  status.add("state", name);
  status.add("reason", state.reason);
  status.add("hint", report.hint);
  status.add("corners", counts.corners);
  status.add("corners with a disparity", counts.with_depth);
  status.add("features tracked and consistent", counts.consistent);
  status.add("inliers of the rotation", counts.rotation_inliers);
  status.add("inliers of the translation", counts.translation_inliers);
  const DisparityBias& bias = report.last_result.disparity_bias;
  status.addf("disparity bias",
              "%.2f +- %.2f px, %.2f px applied",
              bias.estimated_px,
              bias.sigma_px,
              bias.applied_px);
  const RowOffset& rows = report.last_result.row_offset;
  status.addf("row offset of the right image",
              "%.2f +- %.2f px, median difference %.2f px",
              rows.median_px,
              rows.sigma_px,
              rows.typical_px);
  const TimeSkew& skew = report.last_result.time_skew;
  status.addf(
      "delay of the right image", "%.1f +- %.1f ms", 1e3 * skew.estimated_s, 1e3 * skew.sigma_s);
  status.addf("contrast of the right image relative to the left one",
              "%.2f",
              report.last_result.exposure_gain);
  status.addf("flow noise", "%.2f px", report.last_result.flow_noise_px);
  status.add("pairs processed", report.pairs_processed);
  status.add("pairs lost", report.pairs_lost);
}

void describeInput(const HealthReport& report, StatusWrapper& status) {
  const InputReport& input = report.input;
  const std::string why = whyNoPairs(input);
  if (input.recent_pairs == 0) {
    status.summary(DiagnosticStatus::ERROR, why.empty() ? "no stereo pairs" : why);
  } else if (const std::string silent = whySilent(input); !silent.empty()) {
    status.summary(DiagnosticStatus::WARN, silent);
  } else if (const std::string fault = faultOfPairs(input); !fault.empty()) {
    status.summary(DiagnosticStatus::WARN, fault);
  } else if (!why.empty()) {
    status.summary(DiagnosticStatus::WARN, "dropped in the last 5 s: " + why);
  } else {
    status.summary(DiagnosticStatus::OK, "stereo pairs arrive");
  }
  for (const TopicReport* topic :
       {&input.left_image, &input.right_image, &input.left_info, &input.right_info}) {
    addTopic(*topic, status);
  }
  status.addf("pairs", "%zu in 5 s", input.recent_pairs);
  if (input.stamp_difference_s) {
    status.addf(
        "largest stamp difference of left and right", "%.3f ms", 1e3 * *input.stamp_difference_s);
  }
  status.addf("max_stamp_difference_s", "%.3f ms", 1e3 * input.max_stamp_difference_s);
  status.addf("accepted stamp difference", "%.3f ms", 1e3 * input.tolerance_s);
}

void describeTiming(const HealthReport& report, StatusWrapper& status) {
  const double input_hz = report.input.left_image.rate_hz;
  const double period_ms = input_hz > 0.0 ? 1e3 / input_hz : 0.0;
  if (report.answers && period_ms > 0.0 && report.latency_p50_ms > kLateShareOfPeriod * period_ms) {
    status.summaryf(DiagnosticStatus::WARN,
                    "too slow: half of the results take more than %.1f ms, but pairs arrive every "
                    "%.1f ms; reduce feature_detector/max_features, or the rate or size of the "
                    "images",
                    report.latency_p50_ms,
                    period_ms);
  } else {
    status.summaryf(DiagnosticStatus::OK, "%.1f results per second", report.answer_rate_hz);
  }
  status.addf("frequency", "%.2f Hz", report.answer_rate_hz);
  status.addf("latency p50", "%.1f ms", report.latency_p50_ms);
  status.addf("latency p95", "%.1f ms", report.latency_p95_ms);
  status.addf("latency max", "%.1f ms", report.latency_max_ms);
  status.addf("time of the estimator", "%.1f ms", report.last_result.times.total_ms);
}

void describeTf(const HealthReport& report, StatusWrapper& status) {
  if (!report.waits_for_tf.empty()) {
    status.summary(DiagnosticStatus::ERROR, report.waits_for_tf);
  } else if (!report.tf_conflict.empty()) {
    status.summary(DiagnosticStatus::WARN, report.tf_conflict);
  } else {
    status.summary(DiagnosticStatus::OK, "no conflict");
  }
  if (!report.guess_trouble.empty()) {
    status.mergeSummary(DiagnosticStatus::WARN, report.guess_trouble);
  }
  status.add("pairs without the motion of guess_frame", report.guess_misses);
}

std::uint64_t countDrops(const HealthReport& report) {
  std::uint64_t total = 0;
  for (const auto& [reason, count] : report.drops) total += count;
  return total;
}

void describeDrops(const HealthReport& report, std::uint64_t drops_before, StatusWrapper& status) {
  const std::uint64_t total = countDrops(report);
  if (total > drops_before) {
    status.summaryf(DiagnosticStatus::WARN,
                    "%llu more dropped in the last second",
                    static_cast<unsigned long long>(total - drops_before));
  } else {
    status.summary(DiagnosticStatus::OK, "none in the last second");
  }
  status.add("dropped in total", total);
  for (const auto& [reason, count] : report.drops) status.add(toString(reason), count);
}

void describeGyro(const HealthReport& report, StatusWrapper& status) {
  if (!report.gyro) return status.summary(DiagnosticStatus::OK, "no pair yet");
  const GyroReport& gyro = *report.gyro;
  if (gyro.why_not_used.empty()) {
    status.summary(DiagnosticStatus::OK, "predicts rotations");
  } else {
    status.summary(DiagnosticStatus::WARN, "not used: " + gyro.why_not_used);
  }
  status.add("topic", gyro.topic);
  status.addf("bias",
              "%.4f %.4f %.4f rad/s, +- %.4f",
              gyro.bias_rps.x(),
              gyro.bias_rps.y(),
              gyro.bias_rps.z(),
              gyro.bias_sigma_rps);
  status.add("rotations predicted", gyro.counts.predicted);
  status.add("rotations missed", gyro.counts.missed);
  status.add("samples", gyro.counts.samples);
  status.add("samples refused", gyro.counts.refused);
}

Diagnostics::Diagnostics(ros::NodeHandle& nh, ros::NodeHandle& private_nh, const std::string& name)
    : updater_(nh, private_nh, name) {
  updater_.setHardwareID("none");
  // During shutdown there is no publisher, and the first task would abort a Debug build.
  if (ros::isShuttingDown()) return;
  updater_.add("odometry", [this](StatusWrapper& status) { describeOdometry(report_, status); });
  updater_.add("input", [this](StatusWrapper& status) { describeInput(report_, status); });
  updater_.add("timing", [this](StatusWrapper& status) { describeTiming(report_, status); });
  updater_.add("tf", [this](StatusWrapper& status) { describeTf(report_, status); });
  updater_.add("drops",
               [this](StatusWrapper& status) { describeDrops(report_, drops_before_, status); });
}

void Diagnostics::addGyro() {
  if (ros::isShuttingDown()) return;
  updater_.add("gyroscope", [this](StatusWrapper& status) { describeGyro(report_, status); });
}

void Diagnostics::publish(const HealthReport& report) {
  report_ = report;
  updater_.force_update();
  drops_before_ = countDrops(report);
}

}  // namespace rotrocc
