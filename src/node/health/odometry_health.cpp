#include "node/health/odometry_health.h"

#include <cmath>

#include "input/to_text.h"
#include "rotrocc/OdometryStatus.h"

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

NodeState stateOf(const HealthReport& report) {
  if (report.paused) return {OdometryStatus::PAUSED, "paused by the service ~pause"};
  if (report.answers) {
    const OdometryResult& last = report.last_result;
    switch (last.state) {
      case State::kInitialising:
        return {OdometryStatus::INITIALISING, last.reason};
      case State::kOk:
        return {OdometryStatus::OK, ""};
      case State::kDegraded:
        return {OdometryStatus::DEGRADED, last.reason};
      case State::kLost:
        return {OdometryStatus::LOST, last.reason};
    }
  }
  const InputReport& input = report.input;
  const std::string why = whyNoPairs(input);
  if (!input.camera_error.empty()) return {OdometryStatus::NO_CALIBRATION, input.camera_error};
  if (report.not_of_camera) return {OdometryStatus::NO_CALIBRATION, input.refused};
  if (input.waits_for_info) return {OdometryStatus::NO_CALIBRATION, why};
  if (input.recent_pairs > 0 && !report.waits_for_tf.empty()) {
    return {OdometryStatus::NO_TF, report.waits_for_tf};
  }
  return {OdometryStatus::NO_INPUT, why.empty() ? whyNoAnswer(report) : why};
}

std::string HealthReport::statusHint() const {
  const std::string& fault = hint.empty() ? input_fault : hint;
  return fault.empty() || guess_trouble.empty() ? fault + guess_trouble
                                                : fault + "; " + guess_trouble;
}

const char* stateName(std::uint8_t state) {
  static const char* const kNames[] = {
      "INITIALISING", "OK", "DEGRADED", "LOST", "NO_INPUT", "NO_CALIBRATION", "NO_TF", "PAUSED"};
  return state <= OdometryStatus::PAUSED ? kNames[state] : "unknown";
}

void OdometryHealth::addAnswer(const OdometryResult& result,
                               const std::string& hint,
                               double latency_ms) {
  const std::lock_guard<std::mutex> lock(mutex_);
  known_.last_result = result;
  known_.hint = hint;
  known_.waits_for_tf.clear();
  ++known_.pairs_processed;
  if (result.state == State::kLost) ++known_.pairs_lost;
  answers_.add(std::chrono::steady_clock::now());
  latencies_.add(latency_ms);
}

void OdometryHealth::setInputFault(const std::string& fault) {
  const std::lock_guard<std::mutex> lock(mutex_);
  known_.input_fault = fault;
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

void OdometryHealth::setTfConflict(const std::string& conflict) {
  const std::lock_guard<std::mutex> lock(mutex_);
  known_.tf_conflict = conflict;
}

void OdometryHealth::setGuess(const std::string& trouble, std::uint64_t misses) {
  const std::lock_guard<std::mutex> lock(mutex_);
  known_.guess_trouble = trouble;
  known_.guess_misses = misses;
}

void OdometryHealth::setGyro(const GyroReport& gyro) {
  const std::lock_guard<std::mutex> lock(mutex_);
  known_.gyro = gyro;
}

HealthReport OdometryHealth::counts(const DropLog& drops) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  HealthReport report = known_;
  report.drops = drops.counters().nonZero();
  return report;
}

HealthReport OdometryHealth::report(const InputReport& input, const DropLog& drops) const {
  const auto now = std::chrono::steady_clock::now();
  HealthReport report = counts(drops);
  report.input = input;
  const std::lock_guard<std::mutex> lock(mutex_);
  report.answers = answers_.total() > 0 && now - answers_.lastArrival() < kAnswerAge;
  report.answer_rate_hz = answers_.rate_hz(now);
  report.latency_p50_ms = latencies_.quantile(0.5);
  report.latency_p95_ms = latencies_.quantile(0.95);
  report.latency_max_ms = latencies_.quantile(1.0);
  const auto refused = drops.lastWithin(TopicStatistics::kWindow);
  report.not_of_camera = refused && refused->reason() == DropReason::kImageNotOfCamera;
  return report;
}

}  // namespace rotrocc
