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
  const Throttle::Time::duration passed = now - *lost_since_;
  if (status.state == OdometryStatus::OK || status.state == OdometryStatus::DEGRADED) {
    lost_since_.reset();
    if (told_) return log_.info(std::string("recovered: ") + stateName(status.state));
    const double passed_s = std::chrono::duration<double>(passed).count();
    if (throttle_.pass(reason_, now)) {
      log_.warn("lost for " + fixedText(passed_s, 1) + " s: " + reason_);
    }
  } else if (!camera_fault_.empty() || passed >= kPatience) {
    const std::string& cause = camera_fault_.empty() ? reason_ : camera_fault_;
    if (!throttle_.pass(cause, now)) return;
    log_.warn("lost: " + reason_ + (camera_fault_.empty() ? "" : "; " + camera_fault_));
    told_ = true;
  }
}

}  // namespace rotrocc
