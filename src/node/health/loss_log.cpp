#include "node/health/loss_log.h"

#include "input/to_text.h"

namespace rotrocc {

void LossLog::observe(const OdometryResult& result,
                      const std::string& camera_fault,
                      Throttle::Time now) {
  if (result.state == State::kLost && !lost_since_) {
    lost_since_ = now;
    reason_ = result.reason;
    camera_fault_.clear();
    logged_ = false;
  }
  if (!lost_since_) {
    if (!camera_fault.empty() && throttle_.pass(camera_fault, now)) out_.warn(camera_fault);
    return;
  }
  if (!camera_fault.empty()) camera_fault_ = camera_fault;
  if (result.hasMotion()) {
    if (!found_since_) found_since_ = now;
    if (now - *found_since_ >= kRecovery) end(result.state, now);
    return;
  }
  found_since_.reset();
  if (camera_fault_.empty() && now - *lost_since_ < kPatience) return;
  if (log("lost: ", now)) logged_ = true;
}

/// Unless the cause was logged just before; returns whether it is logged now.
bool LossLog::log(const std::string& what, Throttle::Time now) {
  if (!throttle_.pass(camera_fault_.empty() ? reason_ : camera_fault_, now)) return false;
  out_.warn(what + reason_ + (camera_fault_.empty() ? "" : "; " + camera_fault_));
  return true;
}

void LossLog::end(State state, Throttle::Time now) {
  const std::chrono::duration<double> length = *found_since_ - *lost_since_;
  lost_since_.reset();
  found_since_.reset();
  if (logged_) return out_.info(std::string("recovered: ") + toString(state));
  log("lost for " + fixedText(length.count(), 1) + " s: ", now);
}

}  // namespace rotrocc
