#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "input/drop_log.h"
#include "input/input_report.h"
#include "input/topic_statistics.h"
#include "node/latency_window.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// How the odometry is doing: what diagnostics and status are made of.
struct HealthReport {
  InputReport input;
  bool paused = false;
  std::string waits_for_tf;  ///< which transform is missing; empty if none is
  std::string tf_conflict;   ///< who else says where the base is; empty if nobody does

  bool answers = false;        ///< there was an answer lately
  OdometryResult last_result;  ///< of the last answer
  std::string hint;            ///< as PairAnswer::hint
  double answer_rate_hz = 0.0;
  double latency_p50_ms = 0.0, latency_p95_ms = 0.0, latency_max_ms = 0.0;
  std::uint64_t pairs_processed = 0, pairs_lost = 0;
  std::vector<std::pair<DropReason, std::uint64_t>> drops;
  bool not_of_camera = false;  ///< images of another size than camera_info came lately
};

/// The state with constants of OdometryStatus, and why it is not OK.
struct NodeState {
  std::uint8_t state = 0;
  std::string reason;
};

NodeState stateOf(const HealthReport& report);

/// "NO_INPUT", ... of a constant of OdometryStatus.
const char* stateName(std::uint8_t state);

/// Gathers what the worker and the callbacks know of the odometry's health. For any thread.
class OdometryHealth {
 public:
  /// An answer was published `latency_ms` after its pair had come.
  void addAnswer(const OdometryResult& result, const std::string& hint, double latency_ms);
  void setPaused(bool paused);
  bool paused() const;
  void setWaitsForTf(const std::string& transform);
  void setTfConflict(const std::string& conflict);

  HealthReport report(const InputReport& input, const DropLog& drops) const;

 private:
  mutable std::mutex mutex_;
  HealthReport known_;  // the part that others report
  TopicStatistics answers_;
  LatencyWindow latencies_{300};
};

}  // namespace rotrocc
