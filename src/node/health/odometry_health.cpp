#include "node/health/odometry_health.h"

#include <chrono>
#include <cmath>
#include <utility>

#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Without a result for this time, the state is that of the input.
constexpr std::chrono::seconds kAnswerAge(2);

/// If nothing is wrong with the input.
std::string whyNoAnswer(const HealthReport& report) {
  const auto& silent_s = report.input.pairs_silent_s;
  if (!silent_s) return "no stereo pair has arrived yet";
  if (*silent_s < std::chrono::duration<double>(kAnswerAge).count()) {
    return "stereo pairs arrive, but none has been processed in the last 2 s";
  }
  return "no stereo pair for " + toText(std::round(*silent_s)) + " s";
}

}  // namespace

void updateState(HealthReport& report) {
  const auto set = [&report](std::uint8_t state, const std::string& reason) {
    report.status.state = state;
    report.status.reason = reason;
  };
  if (report.paused) return set(OdometryStatus::PAUSED, "paused by the service ~pause");
  if (report.answers) return;
  const InputReport& input = report.input;
  const std::string why = whyNoPairs(input);
  if (!input.camera_error.empty()) return set(OdometryStatus::NO_CALIBRATION, input.camera_error);
  if (input.waits_for_info) return set(OdometryStatus::NO_CALIBRATION, why);
  if (input.recent_pairs > 0 && !report.waits_for_tf.empty()) {
    return set(OdometryStatus::NO_TF, report.waits_for_tf);
  }
  set(OdometryStatus::NO_INPUT, why.empty() ? whyNoAnswer(report) : why);
}

const char* stateName(std::uint8_t state) {
  static const char* const kNames[] = {
      "INITIALISING", "OK", "DEGRADED", "LOST", "NO_INPUT", "NO_CALIBRATION", "NO_TF", "PAUSED"};
  return state <= OdometryStatus::PAUSED ? kNames[state] : "unknown";
}

OdometryStatus OdometryHealth::addAnswer(OdometryStatus status,
                                         const std::string& camera_fault,
                                         const std::string& tf_trouble,
                                         const DropLog& drops) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool lost = status.state == OdometryStatus::LOST;
  status.pairs_processed = known_.status.pairs_processed + 1;
  status.pairs_lost = known_.status.pairs_lost + (lost ? 1 : 0);
  known_.status = std::move(status);
  known_.camera_fault = camera_fault;
  known_.rig_fault = rig_watch_.observe(known_.status);
  known_.tf_trouble = tf_trouble;
  known_.waits_for_tf.clear();
  answers_.add(std::chrono::steady_clock::now());
  latencies_ms_.add(known_.status.latency);
  without_tf_ms_.add(known_.status.latency - known_.status.time_tf);
  updateStatus(drops);
  return known_.status;
}

/// The hint is a fault of the cameras, or else of the input; and of tf.
void OdometryHealth::updateStatus(const DropLog& drops) {
  OdometryStatus& status = known_.status;
  status.hint = known_.camera_fault.empty() ? known_.input_fault : known_.camera_fault;
  if (!status.hint.empty() && !known_.tf_trouble.empty()) status.hint += "; ";
  status.hint += known_.tf_trouble;
  status.drops.clear();
  for (const auto& [reason, count] : drops.counts()) {
    status.drops.emplace_back();
    status.drops.back().reason = toString(reason);
    status.drops.back().count = count;
  }
}

void OdometryHealth::setPaused(bool paused) {
  const std::lock_guard<std::mutex> lock(mutex_);
  known_.paused = paused;
}

bool OdometryHealth::paused() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return known_.paused;
}

void OdometryHealth::setWaitsForTf(const std::string& transform) {
  const std::lock_guard<std::mutex> lock(mutex_);
  known_.waits_for_tf = transform;
}

HealthReport OdometryHealth::report(const InputReport& input,
                                    const DropLog& drops,
                                    TopicStatistics::Time now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  known_.input_fault = input_fault_.observe(faultOfPairs(input), now);
  updateStatus(drops);
  HealthReport report = known_;
  report.input = input;
  report.answers = answers_.total() > 0 && now - answers_.lastArrival() < kAnswerAge;
  if (!report.answers) report.rig_fault.clear();
  report.answer_rate_hz = answers_.rate_hz(now);
  report.latency_p50_ms = latencies_ms_.quantile(0.5);
  report.latency_p95_ms = latencies_ms_.quantile(0.95);
  report.latency_max_ms = latencies_ms_.quantile(1.0);
  report.latency_without_tf_p50_ms = without_tf_ms_.quantile(0.5);
  updateState(report);
  return report;
}

}  // namespace rotrocc
