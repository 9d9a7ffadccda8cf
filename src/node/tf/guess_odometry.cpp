#include "node/tf/guess_odometry.h"

#include <utility>

#include "input/message_conversion.h"
#include "input/to_text.h"
#include "node/tf/sensor_pose.h"

namespace rotrocc {

GuessOdometry::GuessOdometry(const tf2::BufferCore& tf, GuessSource source, Log log)
    : tf_(tf), log_(std::move(log)), source_(std::move(source)) {}

std::optional<Eigen::Isometry3d> GuessOdometry::motionTo(std::int64_t stamp_ns,
                                                         const WaitFor& wait) {
  if (!last_stamp_ns_ || stamp_ns <= *last_stamp_ns_) return std::nullopt;
  const auto is_there = [&] {
    return tf_.canTransform(source_.guess_frame, source_.base_frame, toRosTime(stamp_ns));
  };
  // After misses, waits only if the last transform did come, and not at each pair: waiting would
  // delay all of them.
  if (!is_there() && watch_.waits() &&
      (!watch_.isMissing() || T_guess_last_ || pose(*last_stamp_ns_))) {
    wait(kTimeout_s, is_there);
  }
  const auto current = pose(stamp_ns);
  if (!T_guess_last_) T_guess_last_ = pose(*last_stamp_ns_);
  if (!current || !T_guess_last_) {
    observe(current ? *last_stamp_ns_ : stamp_ns);
    return std::nullopt;
  }
  observe(std::nullopt);
  return T_guess_last_->inverse() * *current;
}

std::optional<Eigen::Isometry3d> GuessOdometry::moveTo(std::int64_t stamp_ns) {
  last_stamp_ns_ = stamp_ns;
  T_guess_last_ = pose(stamp_ns);
  return T_guess_last_;
}

/// T_guess_base at a stamp, if tf already has it.
std::optional<Eigen::Isometry3d> GuessOdometry::pose(std::int64_t stamp_ns) const {
  try {
    return toEigen(tf_.lookupTransform(source_.guess_frame, source_.base_frame, toRosTime(stamp_ns))
                       .transform);
  } catch (const std::exception&) {
    return std::nullopt;  // not available: the previous motion is the prediction
  }
}

/// A motion, or a miss as tf lacks the pose at a stamp.
void GuessOdometry::observe(const std::optional<std::int64_t>& missing_ns) {
  const bool is_new = watch_.observe(!missing_ns);
  if (!missing_ns) {
    problem_.clear();
    if (is_new) log_.info("motions are predicted by " + source_.name);
    return;
  }
  ++misses_;
  if (watch_.isMissing() && problem_.empty()) problem_ = describeMiss(*missing_ns);
  if (is_new) log_.warn(problem_);
}

std::string GuessOdometry::describeMiss(std::int64_t stamp_ns) const {
  std::string cause = source_.why_not();
  if (!cause.empty()) return "no pose from " + source_.name + ": " + cause;
  tf_.canTransform(source_.guess_frame, source_.base_frame, toRosTime(stamp_ns), &cause);
  cause.erase(cause.find_last_not_of(". ") + 1);
  if (cause.empty()) cause = "it came too late";
  const bool late = tf_.canTransform(source_.guess_frame, source_.base_frame, ros::Time());
  return "no pose from " + source_.name + " at " + std::to_string(SourceWatch::kPairs) +
         " pairs in a row (" + cause + "), pairs no longer wait for it: " +
         (late ? "publish it within " + toText(kTimeout_s) +
                     " s of its stamp, or synchronize the clocks"
               : "correct the parameter, or start that odometry");
}

}  // namespace rotrocc
