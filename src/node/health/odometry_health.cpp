#include "node/health/odometry_health.h"

#include <cmath>

#include "input/message_conversion.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Without a result for this time, the state is that of the input.
constexpr double kAnswerAge_s = 2.0;

/// Rigs are rarely better calibrated; the correction is right on average only, and leaves more of a
/// larger bias.
constexpr double kLargeBias_px = 0.5;
/// More than a good rectification leaves, and more than the matching of small windows tolerates.
constexpr double kRowsApart_px = 0.5;
/// Standard deviations of a significant fault.
constexpr double kSigmas = 4.0;

/// If nothing is wrong with the input.
std::string whyNoAnswer(const HealthReport& report) {
  const auto& silent_s = report.input.pairs_silent_s;
  if (!silent_s) return "no stereo pair has arrived yet";
  if (*silent_s < kAnswerAge_s) {
    return "stereo pairs arrive, but none has been processed in the last 2 s";
  }
  return "no stereo pair for " + toText(std::round(*silent_s)) + " s";
}

std::uint8_t toMessage(State state) {
  switch (state) {
    case State::kInitializing:
      return OdometryStatus::INITIALIZING;
    case State::kOk:
      return OdometryStatus::OK;
    case State::kDegraded:
      return OdometryStatus::DEGRADED;
    case State::kLost:
      break;
  }
  return OdometryStatus::LOST;
}

/// A fault of the cameras, or else of the input; and of tf.
std::string hintOf(const HealthReport& report) {
  const PairReport& pair = report.pair;
  std::string hint = pair.camera_fault.empty() ? report.input_fault : pair.camera_fault;
  if (!hint.empty() && !pair.tf_problem.empty()) hint += "; ";
  return hint + pair.tf_problem;
}

/// In one sentence with a remedy; empty if there is none.
std::string faultOfRig(const OdometryResult& result) {
  const DisparityBias& bias = result.disparity_bias;
  const RowOffset& rows = result.row_offset;
  const RightDelay& delay = result.right_delay;
  std::string what;
  if (std::abs(bias.applied_px) >= kLargeBias_px &&
      std::abs(bias.estimated_px) >= kSigmas * bias.sigma_px) {
    what = "disparities have a bias of " + hundredths(-bias.estimated_px) + " px (+- " +
           hundredths(bias.sigma_px) + "), which is corrected";
  }
  // Chance matches of exchanged images are few before the next loss discards them.
  if (rows.typical_px >= kRowsApart_px && kSigmas * rows.sigma_px <= kRowsApart_px) {
    what += (what.empty() ? "" : "; ") + std::string("rows of left and right differ by ") +
            hundredths(rows.typical_px) + " px, with a median offset of " +
            hundredths(rows.median_px) + " px (+- " + hundredths(rows.sigma_px) + ")" +
            (rows.applied_px != 0.0 ? ", which is corrected" : "");
  }
  if (!what.empty()) what += ": recalibrate the stereo rig";
  if (delay.applied_s != 0.0 && std::abs(delay.estimated_s) >= kSigmas * delay.sigma_s) {
    what += (what.empty() ? "" : "; ") + std::string("right images are taken ") +
            hundredths(1e3 * delay.estimated_s) + " ms (+- " + hundredths(1e3 * delay.sigma_s) +
            ") after the left ones, which is corrected: trigger both cameras together";
  }
  return what;
}

/// Sets state, hint and counters of the node.
void addState(const HealthReport& report, OdometryStatus& message) {
  message.state = report.state;
  message.reason = report.reason;
  message.hint = hintOf(report);
  message.pairs_processed = report.pairs_processed;
  message.pairs_lost = report.pairs_lost;
  for (const auto& [reason, count] : report.drops) {
    message.drops.emplace_back();
    message.drops.back().reason = toString(reason);
    message.drops.back().count = count;
  }
}

}  // namespace

void updateState(HealthReport& report) {
  const auto set = [&report](std::uint8_t state, const std::string& reason) {
    report.state = state;
    report.reason = reason;
  };
  if (report.paused) return set(OdometryStatus::PAUSED, "paused by the service ~pause");
  if (report.answers) return;
  const InputReport& input = report.input;
  const auto why = whyNoPairs(input);
  if (!input.camera_error.empty()) return set(OdometryStatus::NO_CALIBRATION, input.camera_error);
  if (input.waits_for_info) {
    return set(OdometryStatus::NO_CALIBRATION, why.value_or("pairs are waiting for camera_info"));
  }
  if (input.recent_pairs > 0 && !report.waits_for_tf.empty()) {
    return set(OdometryStatus::NO_TF, report.waits_for_tf);
  }
  set(OdometryStatus::NO_INPUT, why ? *why : whyNoAnswer(report));
}

const char* stateName(std::uint8_t state) {
  static const char* const kNames[] = {
      "INITIALIZING", "OK", "DEGRADED", "LOST", "NO_INPUT", "NO_CALIBRATION", "NO_TF", "PAUSED"};
  return state <= OdometryStatus::PAUSED ? kNames[state] : "unknown";
}

OdometryStatus toStatus(const HealthReport& report) {
  const OdometryResult& result = report.pair.result;
  OdometryStatus message = report.pair.status;
  addState(report, message);
  message.header.stamp = toRosTime(result.stamp_ns);
  message.dt_s = result.dt_s();
  message.tries = static_cast<std::uint32_t>(result.counts.tries);
  message.corners = static_cast<std::uint32_t>(result.counts.corners);
  message.with_depth = static_cast<std::uint32_t>(result.counts.with_depth);
  message.tracked = static_cast<std::uint32_t>(result.counts.tracked);
  message.consistent = static_cast<std::uint32_t>(result.counts.consistent);
  message.rotation_inliers = static_cast<std::uint32_t>(result.counts.rotation_inliers);
  message.translation_inliers = static_cast<std::uint32_t>(result.counts.translation_inliers);
  message.disparity_bias_px = static_cast<float>(result.disparity_bias.estimated_px);
  message.disparity_bias_sigma_px = static_cast<float>(result.disparity_bias.sigma_px);
  message.disparity_bias_applied_px = static_cast<float>(result.disparity_bias.applied_px);
  message.row_offset_px = static_cast<float>(result.row_offset.median_px);
  message.row_offset_sigma_px = static_cast<float>(result.row_offset.sigma_px);
  message.row_offset_applied_px = static_cast<float>(result.row_offset.applied_px);
  message.row_difference_px = static_cast<float>(result.row_offset.typical_px);
  message.right_delay_s = static_cast<float>(result.right_delay.estimated_s);
  message.right_delay_sigma_s = static_cast<float>(result.right_delay.sigma_s);
  message.right_delay_applied_s = static_cast<float>(result.right_delay.applied_s);
  message.contrast_gain = static_cast<float>(result.contrast_gain);
  message.halvings = static_cast<std::int8_t>(result.halvings);
  message.flow_noise_px = static_cast<float>(result.flow_noise_px);
  message.pyramids_ms = static_cast<float>(result.times.pyramids_ms);
  message.corners_ms = static_cast<float>(result.times.corners_ms);
  message.disparity_ms = static_cast<float>(result.times.disparity_ms);
  message.tracking_ms = static_cast<float>(result.times.tracking_ms);
  message.estimation_ms = static_cast<float>(result.times.estimation_ms);
  message.prepared_ms = static_cast<float>(result.times.prepared_ms);
  message.estimator_ms = static_cast<float>(result.times.total_ms);
  return message;
}

OdometryStatus toIdleStatus(const HealthReport& report, const ros::Time& stamp) {
  OdometryStatus message;
  message.header.stamp = stamp;
  message.imu_reason = report.pair.status.imu_reason;
  message.rotations_predicted = report.pair.status.rotations_predicted;
  message.rotations_missed = report.pair.status.rotations_missed;
  message.guess_misses = report.pair.status.guess_misses;
  addState(report, message);
  return message;
}

HealthReport OdometryHealth::addPair(const PairReport& pair,
                                     const DropLog& drops,
                                     TopicStatistics::Time now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.pair = pair;
  status_.state = toMessage(pair.result.state);
  status_.reason = pair.result.reason;
  ++status_.pairs_processed;
  status_.pairs_lost += pair.result.state == State::kLost ? 1 : 0;
  if (pair.result.hasMotion()) {
    // What a camera fault does to disparities and rows is none of the rig.
    const std::string fault = pair.camera_fault.empty() ? faultOfRig(pair.result) : "";
    status_.rig_fault = rig_fault_.observe(fault, now);
  }
  status_.drops = drops.counts();
  answers_.add(now);
  latencies_ms_.push_back(pair.status.latency_ms);
  without_tf_ms_.push_back(pair.status.latency_ms - pair.status.tf_ms);
  return status_;
}

void OdometryHealth::setPaused(bool paused) {
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.paused = paused;
}

bool OdometryHealth::paused() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_.paused;
}

void OdometryHealth::setWaitsForTf(const std::string& transform) {
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.waits_for_tf = transform;
}

HealthReport OdometryHealth::report(const InputReport& input,
                                    const DropLog& drops,
                                    TopicStatistics::Time now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.input_fault = input_fault_.observe(faultOfPairs(input).value_or(""), now);
  status_.drops = drops.counts();
  HealthReport report = status_;
  report.input = input;
  report.answers = answers_.silent_s(now).value_or(kAnswerAge_s) < kAnswerAge_s;
  if (!report.answers) report.rig_fault.clear();
  report.answer_rate_hz = answers_.rate_hz(now);
  report.latency_p50_ms = quantileOf(latencies_ms_, 0.5);
  report.latency_p95_ms = quantileOf(latencies_ms_, 0.95);
  report.latency_max_ms = quantileOf(latencies_ms_, 1.0);
  report.latency_without_tf_p50_ms = quantileOf(without_tf_ms_, 0.5);
  updateState(report);
  return report;
}

}  // namespace rotrocc
