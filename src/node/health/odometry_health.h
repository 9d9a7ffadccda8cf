#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "input/drop_log.h"
#include "input/input_report.h"
#include "input/topic_statistics.h"
#include "node/gyro/gyro_report.h"
#include "node/health/latency_window.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// State of the odometry, for diagnostics and status.
struct HealthReport {
  InputReport input;
  bool paused = false;
  std::string waits_for_tf;        ///< which transform is missing; empty if none is
  std::string tf_conflict;         ///< other publisher of a parent of the base; empty if none
  std::string guess_trouble;       ///< why tf has no motion of guess_frame; empty if it has
  std::uint64_t guess_misses = 0;  ///< pairs without that motion
  std::optional<GyroReport> gyro;  ///< none if it is not used

  bool answers = false;        ///< there was a recent result
  OdometryResult last_result;  ///< last result
  std::string hint;            ///< as PairAnswer::hint
  std::string input_fault;     ///< of the pairs that arrive, see faultOfPairs(); empty if none
  double answer_rate_hz = 0.0;
  double latency_p50_ms = 0.0, latency_p95_ms = 0.0, latency_max_ms = 0.0;
  std::uint64_t pairs_processed = 0, pairs_lost = 0;
  std::vector<std::pair<DropReason, std::uint64_t>> drops;
  bool not_of_camera = false;  ///< recent images differ in size from camera_info

  /// The hint of the status: a fault of the cameras, or else of the input; and of guess_frame.
  std::string statusHint() const;
};

/// The state with constants of OdometryStatus, and why it is not OK.
struct NodeState {
  std::uint8_t state = 0;
  std::string reason;
};

NodeState stateOf(const HealthReport& report);

/// Name of a constant of OdometryStatus, e.g. "NO_INPUT".
const char* stateName(std::uint8_t state);

/// Collects the state of worker and callbacks. Thread-safe.
class OdometryHealth {
 public:
  /// A result was published `latency_ms` after the arrival of its pair.
  void addAnswer(const OdometryResult& result, const std::string& hint, double latency_ms);
  void setInputFault(const std::string& fault);
  void setPaused(bool paused);
  bool paused() const;
  void setWaitsForTf(const std::string& transform);
  void setTfConflict(const std::string& conflict);
  void setGuess(const std::string& trouble, std::uint64_t misses);
  void setGyro(const GyroReport& gyro);

  HealthReport report(const InputReport& input, const DropLog& drops) const;

  /// The same without input, rate and latencies: for the status of each pair.
  HealthReport counts(const DropLog& drops) const;

 private:
  mutable std::mutex mutex_;
  HealthReport known_;  // reported by others
  TopicStatistics answers_;
  LatencyWindow latencies_{300};
};

}  // namespace rotrocc
