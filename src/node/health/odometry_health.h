#pragma once

#include <cstdint>
#include <mutex>
#include <string>

#include "input/input_error.h"
#include "input/input_report.h"
#include "input/log.h"
#include "node/health/sliding_quantiles.h"
#include "rotrocc/OdometryStatus.h"
#include "rotrocc/odometry_result.h"

namespace rotrocc {

/// What is known of a pair when its odometry has been sent.
struct PairReport {
  OdometryResult result;
  OdometryStatus status;     ///< frame, age, times on its way, guess_misses, and of the gyroscope
  std::string camera_fault;  ///< see PairInspector; empty if none
  std::string tf_problem;    ///< of guess_frame or of a camera that moves; empty if none
};

/// State of the node, for status and diagnostics.
struct HealthReport {
  std::uint8_t state = OdometryStatus::NO_INPUT;  ///< of the last pair, or the current one
  std::string reason;                             ///< why it is not OK
  PairReport pair;                                ///< the last one
  std::uint64_t pairs_processed = 0, pairs_lost = 0;
  DropCounts drops;
  InputReport input;
  bool paused = false;
  bool answers = false;      ///< a pair was processed recently
  std::string input_fault;   ///< of the pairs that arrive, see faultOfPairs(), if it lasts
  std::string rig_fault;     ///< a disparity bias or row offset that lasts; empty if none
  std::string waits_for_tf;  ///< which transform is missing or late; empty if none is
  std::string tf_conflict;   ///< other publisher of a parent of the base; empty if none
  double answer_rate_hz = 0.0;
  double latency_p50_ms = 0.0, latency_p95_ms = 0.0, latency_max_ms = 0.0;
  double latency_without_tf_p50_ms = 0.0;  ///< without the time for which pairs wait for tf
};

/// Sets the state and its reason, which are those of the last pair, if there was none recently or
/// the odometry is paused.
void updateState(HealthReport& report);

/// Name of a constant of OdometryStatus, e.g. "NO_INPUT".
const char* stateName(std::uint8_t state);

/// The message of the last pair.
OdometryStatus toStatus(const HealthReport& report);
/// The message without a recent pair: state, hint and counters.
OdometryStatus toIdleStatus(const HealthReport& report, const ros::Time& stamp);

/// Collects the state of worker and callbacks. Thread-safe.
class OdometryHealth {
 public:
  /// The odometry of a pair was published. Returns the state after it.
  HealthReport addPair(const PairReport& pair,
                       const DropLog& drops,
                       TopicStatistics::Time now = std::chrono::steady_clock::now());
  void setPaused(bool paused);
  bool paused() const;
  void setWaitsForTf(const std::string& transform);

  /// All but tf_conflict. The fault of this input is in the hints of the next pairs.
  HealthReport report(const InputReport& input,
                      const DropLog& drops,
                      TopicStatistics::Time now = std::chrono::steady_clock::now());

 private:
  mutable std::mutex mutex_;
  HealthReport status_;
  TopicStatistics answers_;
  LastingFault rig_fault_{std::chrono::seconds(2)};  // single pairs may be wrong
  LastingFault input_fault_{TopicStatistics::kWindow};
  Latest latencies_ms_{300};
  Latest without_tf_ms_{300};
};

}  // namespace rotrocc
