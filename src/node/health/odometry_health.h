#pragma once

#include <cstdint>
#include <mutex>
#include <string>

#include "input/drop_log.h"
#include "input/input_report.h"
#include "input/log.h"
#include "input/topic_statistics.h"
#include "node/health/rig_watch.h"
#include "node/health/sliding_quantiles.h"
#include "rotrocc/OdometryStatus.h"

namespace rotrocc {

/// State of the node, for status and diagnostics.
struct HealthReport {
  OdometryStatus status;  ///< of the last pair, with the state, the hint and the counters of now
  InputReport input;
  bool paused = false;
  bool answers = false;      ///< a pair was processed recently
  std::string camera_fault;  ///< see PairInspector; empty if none
  std::string input_fault;   ///< of the pairs that arrive, see faultOfPairs(), if it lasts
  std::string rig_fault;     ///< see RigWatch; empty if none
  std::string tf_trouble;    ///< of guess_frame or of a mount that moves; empty if none
  std::string waits_for_tf;  ///< which transform is missing; empty if none is
  std::string tf_conflict;   ///< other publisher of a parent of the base; empty if none
  double answer_rate_hz = 0.0;
  double latency_p50_ms = 0.0, latency_p95_ms = 0.0, latency_max_ms = 0.0;
  double latency_without_tf_p50_ms = 0.0;  ///< without the time for which pairs wait for tf
};

/// Sets state and reason of the status, which are those of the last pair, if there was none
/// recently or the odometry is paused.
void updateState(HealthReport& report);

/// Name of a constant of OdometryStatus, e.g. "NO_INPUT".
const char* stateName(std::uint8_t state);

/// Collects the state of worker and callbacks. Thread-safe.
class OdometryHealth {
 public:
  /// The odometry of a pair was published. Returns its status with the hint and the counters that
  /// it lacks.
  OdometryStatus addAnswer(OdometryStatus status,
                           const std::string& camera_fault,
                           const std::string& tf_trouble,
                           const DropLog& drops);
  void setPaused(bool paused);
  bool paused() const;
  void setWaitsForTf(const std::string& transform);

  /// All but tf_conflict. The fault of this input is in the hints of the next pairs.
  HealthReport report(const InputReport& input,
                      const DropLog& drops,
                      TopicStatistics::Time now = std::chrono::steady_clock::now());

 private:
  void updateStatus(const DropLog& drops);

  mutable std::mutex mutex_;
  HealthReport known_;
  TopicStatistics answers_;
  RigWatch rig_watch_;
  LastingFault input_fault_{TopicStatistics::kWindow};
  SlidingQuantiles latencies_ms_{300};
  SlidingQuantiles without_tf_ms_{300};
};

}  // namespace rotrocc
