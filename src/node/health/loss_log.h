#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "input/log.h"
#include "rotrocc/odometry_result.h"

namespace rotrocc {

/// Logs lost motions and camera faults, one line for each: a loss as soon as its cause is found,
/// after kPatience at the latest, or at its end. A cause that lasts or returns is logged at growing
/// intervals. Chance matches may look like a motion: a loss has ended when
/// there were motions for kRecovery.
class LossLog {
 public:
  static constexpr std::chrono::seconds kPatience{2};
  static constexpr std::chrono::seconds kRecovery{1};

  explicit LossLog(Log log) : out_(std::move(log)) {}

  /// Call for each pair. `camera_fault`: see PairInspector; empty if none.
  void observe(const OdometryResult& result,
               const std::string& camera_fault,
               Throttle::Time now = std::chrono::steady_clock::now());

 private:
  bool log(const std::string& what, Throttle::Time now);
  void end(State state, Throttle::Time now);

  Log out_;
  FaultThrottle throttle_;
  std::optional<Throttle::Time> lost_since_, found_since_;
  std::string reason_;        // of the loss, at its first pair
  std::string camera_fault_;  // that caused it, as far as it is known
  bool logged_ = false;       // the loss
};

}  // namespace rotrocc
