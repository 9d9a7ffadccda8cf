#include "node/health/diagnostics.h"

#include <algorithm>
#include <cmath>

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <ros/init.h>

#include "input/to_text.h"

namespace rotrocc {
namespace {

using diagnostic_msgs::DiagnosticStatus;

unsigned char levelOf(std::uint8_t state) {
  switch (state) {
    case OdometryStatus::OK:
    case OdometryStatus::INITIALIZING:
      return DiagnosticStatus::OK;
    case OdometryStatus::DEGRADED:
    case OdometryStatus::PAUSED:
      return DiagnosticStatus::WARN;
    default:
      return DiagnosticStatus::ERROR;
  }
}

}  // namespace

void describeOdometry(const HealthReport& report, StatusWrapper& status) {
  const std::string name = stateName(report.state);
  status.summary(levelOf(report.state), report.reason.empty() ? name : name + ": " + report.reason);
  for (const std::string& warning : {report.pair.camera_fault, report.rig_fault}) {
    if (!warning.empty()) status.mergeSummary(DiagnosticStatus::WARN, warning);
  }
  status.add("state", name);
  status.add("reason", report.reason);
  status.add("hint", report.pair.camera_fault);
  status.add("pairs processed", report.pairs_processed);
  status.add("pairs lost", report.pairs_lost);
}

void describeInput(const HealthReport& report, StatusWrapper& status) {
  const InputReport& input = report.input;
  const auto why = whyNoPairs(input);
  if (input.recent_pairs == 0) {
    status.summary(DiagnosticStatus::ERROR, why.value_or("no stereo pairs"));
  } else if (const auto silent = whySilent(input)) {
    status.summary(DiagnosticStatus::WARN, *silent);
  } else if (!report.input_fault.empty()) {
    status.summary(DiagnosticStatus::WARN, report.input_fault);
  } else if (why) {
    status.summary(DiagnosticStatus::WARN, "dropped in the last 5 s: " + *why);
  } else if (isOfAnotherClock(input)) {
    status.summary(DiagnosticStatus::OK,
                   "stereo pairs arrive with timestamps from another clock: a replay without "
                   "--clock, or a driver that does not stamp in ROS time");
  } else {
    status.summary(DiagnosticStatus::OK, "stereo pairs arrive");
  }
  for (const TopicReport* topic : input.topics()) {
    status.addf(topic->topic,
                "%.1f Hz, %zu in 5 s, %llu in total, %zu publishers",
                topic->rate_hz,
                topic->recent,
                static_cast<unsigned long long>(topic->total),
                topic->publishers);
  }
  status.addf("pairs", "%zu in 5 s", input.recent_pairs);
  if (input.skew) {
    status.addf("largest left-right stamp difference", "%.3f ms", 1e3 * input.skew->largest_s);
  }
  if (input.stamp_age_s) {
    status.addf("age of left image stamps", "%.3f s", *input.stamp_age_s);
  }
  status.addf("jitter of left image stamps", "%.3f ms", 1e3 * input.stamp_scatter_s);
  status.addf("jitter of left image arrivals", "%.3f ms", 1e3 * input.arrival_scatter_s);
  status.addf("max_stamp_difference_s", "%.3f ms", 1e3 * input.max_stamp_difference_s);
  status.addf("accepted stamp difference", "%.3f ms", 1e3 * input.tolerance_s);
}

void describeTiming(const HealthReport& report, StatusWrapper& status) {
  const double input_hz = report.input.left_image.rate_hz;
  const double period_ms = input_hz > 0.0 ? 1e3 / input_hz : 0.0;
  // Latencies vary with the load of the machine: warn only if most pairs are late.
  if (report.answers && period_ms > 0.0 && report.latency_p50_ms > period_ms) {
    status.summaryf(
        DiagnosticStatus::WARN,
        "too slow: half of the results take more than %.1f ms, but pairs arrive every "
        "%.1f ms; %s",
        report.latency_p50_ms,
        period_ms,
        report.latency_without_tf_p50_ms > period_ms
            ? "reduce feature_detector/wanted_inliers, or the rate or size of the images"
            : "they wait for tf: publish it earlier or more often");
  } else {
    status.summaryf(DiagnosticStatus::OK, "%.1f results per second", report.answer_rate_hz);
  }
  status.addf("frequency", "%.2f Hz", report.answer_rate_hz);
  status.addf("latency p50", "%.1f ms", report.latency_p50_ms);
  status.addf("latency p95", "%.1f ms", report.latency_p95_ms);
  status.addf("latency max", "%.1f ms", report.latency_max_ms);
  status.addf("estimator time", "%.1f ms", report.pair.result.times.total_ms);
}

void describeTf(const HealthReport& report, StatusWrapper& status) {
  if (!report.waits_for_tf.empty()) {
    status.summary(DiagnosticStatus::ERROR, report.waits_for_tf);
  } else if (!report.tf_conflict.empty()) {
    status.summary(DiagnosticStatus::WARN, report.tf_conflict);
  } else {
    status.summary(DiagnosticStatus::OK, "no conflict");
  }
  if (!report.pair.tf_problem.empty()) {
    status.mergeSummary(DiagnosticStatus::WARN, report.pair.tf_problem);
  }
  status.add("pairs without a motion from guess_frame or guess_topic",
             report.pair.status.guess_misses);
}

void describeDrops(const HealthReport& report, std::uint64_t drops_before, StatusWrapper& status) {
  const std::uint64_t total = totalOf(report.drops);
  if (total > drops_before) {
    status.summaryf(DiagnosticStatus::WARN,
                    "%llu more dropped since the last report",
                    static_cast<unsigned long long>(total - drops_before));
  } else {
    status.summary(DiagnosticStatus::OK, "none since the last report");
  }
  status.add("dropped in total", total);
  for (const auto& [reason, count] : report.drops) status.add(toString(reason), count);
}

void describeGyro(const GyroPredictor& gyro, const std::string& topic, StatusWrapper& status) {
  const GyroPredictor::Counts& counts = gyro.counts();
  if (counts.predicted + counts.missed == 0) {
    status.summary(DiagnosticStatus::OK, "no pair yet");
  } else if (!gyro.whyNot()) {
    status.summary(DiagnosticStatus::OK, "predicts rotations");
  } else {
    status.summary(DiagnosticStatus::WARN, "not used: " + *gyro.whyNot());
  }
  const Eigen::Vector3d& bias_rps = gyro.bias().bias_rps();
  status.add("topic", topic);
  status.addf("bias",
              "%.4f %.4f %.4f rad/s, +- %.4f",
              bias_rps.x(),
              bias_rps.y(),
              bias_rps.z(),
              std::sqrt(gyro.bias().covariance().trace()));
  status.add("rotations predicted", counts.predicted);
  status.add("rotations missed", counts.missed);
  status.add("samples", counts.samples);
  status.add("samples rejected", counts.rejected);
}

Diagnostics::Diagnostics(ros::NodeHandle& nh, ros::NodeHandle& private_nh, const std::string& name)
    : updater_(nh, private_nh, name) {
  updater_.setHardwareID("none");
  private_nh.getParam("diagnostic_period", period_s_);
  add("odometry", [this](StatusWrapper& status) { describeOdometry(report_, status); });
  add("input", [this](StatusWrapper& status) { describeInput(report_, status); });
  add("timing", [this](StatusWrapper& status) { describeTiming(report_, status); });
  add("tf", [this](StatusWrapper& status) { describeTf(report_, status); });
  add("drops", [this](StatusWrapper& status) { describeDrops(report_, drops_before_, status); });
}

void Diagnostics::add(const std::string& name, const std::function<void(StatusWrapper&)>& task) {
  // During shutdown there is no publisher, and the first task would abort a Debug build.
  if (!ros::isShuttingDown()) updater_.add(name, task);
}

void Diagnostics::publish(const HealthReport& report) {
  // Not by update(): simulated time may stand still. Half a call early, as no call is in time.
  const auto now = std::chrono::steady_clock::now();
  const std::chrono::duration<double> passed = now - published_ + std::chrono::milliseconds(500);
  if (passed.count() < period_s_) return;
  published_ = now;
  report_ = report;
  updater_.force_update();
  drops_before_ = totalOf(report.drops);
}

}  // namespace rotrocc
