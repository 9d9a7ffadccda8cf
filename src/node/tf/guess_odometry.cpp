#include "node/tf/guess_odometry.h"

#include <utility>

#include <tf2/exceptions.h>

#include "input/message_conversion.h"
#include "input/to_text.h"
#include "node/tf/sensor_mount.h"

namespace rotrocc {

GuessOdometry::GuessOdometry(const std::string& guess_frame,
                             const std::string& base_frame,
                             double timeout_s,
                             const TfFeed& feed,
                             Log log)
    : log_(std::move(log)),
      guess_frame_(guess_frame),
      base_frame_(base_frame),
      timeout_s_(timeout_s),
      listener_(feed(buffer_)) {}

std::optional<Eigen::Isometry3d> GuessOdometry::motionTo(std::int64_t stamp_ns) {
  if (!last_stamp_ns_ || stamp_ns <= *last_stamp_ns_) return std::nullopt;
  auto current = pose(stamp_ns);
  // After misses, waits only if the last transform did come, and not at each pair: waiting would
  // delay all of them.
  if (!current && backoff_.waits() &&
      (!backoff_.hasBegun() || T_guess_last_ || pose(*last_stamp_ns_)) &&
      waitForTransform(buffer_, guess_frame_, base_frame_, toRosTime(stamp_ns), timeout_s_)) {
    current = pose(stamp_ns);
  }
  if (!T_guess_last_) T_guess_last_ = pose(*last_stamp_ns_);
  if (!current || !T_guess_last_) {
    onMiss(current ? *last_stamp_ns_ : stamp_ns);
    return std::nullopt;
  }
  onMotion();
  return T_guess_last_->inverse() * *current;
}

std::optional<Eigen::Isometry3d> GuessOdometry::moveTo(std::int64_t stamp_ns,
                                                       bool starts_trajectory) {
  if (starts_trajectory) buffer_.clear();
  last_stamp_ns_ = stamp_ns;
  T_guess_last_ = pose(stamp_ns);
  return T_guess_last_;
}

/// T_guess_base at a stamp, if tf already has it.
std::optional<Eigen::Isometry3d> GuessOdometry::pose(std::int64_t stamp_ns) const {
  try {
    return toEigen(
        buffer_.lookupTransform(guess_frame_, base_frame_, toRosTime(stamp_ns)).transform);
  } catch (const std::exception&) {
    return std::nullopt;  // not available: the previous motion is the prediction
  }
}

void GuessOdometry::onMiss(std::int64_t stamp_ns) {
  ++misses_;
  backoff_.onMiss();
  if (!backoff_.hasBegun() || !trouble_.empty()) return;
  trouble_ = describeMiss(stamp_ns);
  log_.warn(trouble_);
}

void GuessOdometry::onMotion() {
  if (!trouble_.empty()) {
    log_.info("tf from guess_frame " + guess_frame_ + " to " + base_frame_ + " is back, after " +
              std::to_string(backoff_.misses()) + " pairs without it");
  }
  trouble_.clear();
  backoff_.onHit();
}

std::string GuessOdometry::describeMiss(std::int64_t stamp_ns) const {
  std::string cause = "it came too late";
  bool late = true;
  try {
    toEigen(buffer_.lookupTransform(guess_frame_, base_frame_, toRosTime(stamp_ns)).transform);
  } catch (const tf2::ExtrapolationException& error) {
    cause = error.what();
  } catch (const std::exception& error) {
    cause = error.what();
    late = false;
  }
  cause.erase(cause.find_last_not_of(". ") + 1);
  return "no tf from guess_frame " + guess_frame_ + " to " + base_frame_ + " at " +
         std::to_string(MissBackoff::kMisses) + " pairs in a row (" + cause +
         "), pairs do not wait for it: " +
         (late ? "send it within " + toText(timeout_s_) + " s, or synchronise the clocks"
               : "correct guess_frame, or start the odometry that publishes it");
}

}  // namespace rotrocc
