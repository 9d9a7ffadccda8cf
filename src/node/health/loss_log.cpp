#include "node/health/loss_log.h"

#include "input/to_text.h"
#include "node/health/odometry_health.h"

namespace rotrocc {

void LossLog::observe(const OdometryStatus& status,
                      const std::string& camera_fault,
                      Throttle::Time now) {
  if (status.state == OdometryStatus::LOST && !lost_since_) {
    lost_since_ = now;
    reason_ = status.reason;
    camera_fault_.clear();
    told_ = false;
  }
  if (!lost_since_) {
    if (!camera_fault.empty() && throttle_.pass(camera_fault, now)) log_.warn(camera_fault);
    return;
  }
  if (!camera_fault.empty()) camera_fault_ = camera_fault;
  if (status.state == OdometryStatus::OK || status.state == OdometryStatus::DEGRADED) {
    if (!found_since_) found_since_ = now;
    if (now - *found_since_ >= kRecovery) end(status.state, now);
    return;
  }
  found_since_.reset();
  if (camera_fault_.empty() && now - *lost_since_ < kPatience) return;
  if (tell("lost: ", now)) told_ = true;
}

/// Unless the cause was told just before; returns whether it is told now.
bool LossLog::tell(const std::string& what, Throttle::Time now) {
  if (!throttle_.pass(camera_fault_.empty() ? reason_ : camera_fault_, now)) return false;
  log_.warn(what + reason_ + (camera_fault_.empty() ? "" : "; " + camera_fault_));
  return true;
}

void LossLog::end(std::uint8_t state, Throttle::Time now) {
  const std::chrono::duration<double> length = *found_since_ - *lost_since_;
  lost_since_.reset();
  found_since_.reset();
  if (told_) return log_.info(std::string("recovered: ") + stateName(state));
  tell("lost for " + fixedText(length.count(), 1) + " s: ", now);
}

}  // namespace rotrocc
