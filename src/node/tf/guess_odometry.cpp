#include "node/tf/guess_odometry.h"

#include <thread>
#include <utility>

#include <ros/init.h>
#include <tf2/exceptions.h>

#include "input/message_conversion.h"
#include "input/to_text.h"
#include "node/tf/camera_mount.h"

namespace rotrocc {
namespace {

constexpr std::chrono::milliseconds kPoll(2);

}  // namespace

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

std::optional<Eigen::Isometry3d> GuessOdometry::motion(std::int64_t prev_ns, std::int64_t cur_ns) {
  auto current = pose(cur_ns);
  if (!current && mayWait(prev_ns)) current = waitForPose(cur_ns);
  const auto previous = pose(prev_ns);
  if (!current || !previous) {
    onMiss(current ? prev_ns : cur_ns);
    return std::nullopt;
  }
  onMotion();
  return previous->inverse() * *current;
}

/// After misses, only if the previous transform did come, and not at each pair: waiting would delay
/// all of them.
bool GuessOdometry::mayWait(std::int64_t prev_ns) const {
  return patience_.waits() && (!patience_.hasEnded() || pose(prev_ns));
}

std::optional<Eigen::Isometry3d> GuessOdometry::waitForPose(std::int64_t stamp_ns) const {
  // In real time: ROS time may stand still.
  const auto deadline =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s_);
  std::optional<Eigen::Isometry3d> found;
  while (!found && !ros::isShuttingDown() && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(kPoll);
    found = pose(stamp_ns);
  }
  return found;
}

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
  patience_.onMiss();
  if (!patience_.hasEnded() || !trouble_.empty()) return;
  trouble_ = describeMiss(stamp_ns);
  log_.warn(trouble_);
}

void GuessOdometry::onMotion() {
  if (!trouble_.empty()) {
    log_.info("tf from guess_frame " + guess_frame_ + " to " + base_frame_ + " is back, after " +
              std::to_string(patience_.misses()) + " pairs without it");
  }
  trouble_.clear();
  patience_.onAnswer();
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
         std::to_string(Patience::kMisses) + " pairs in a row (" + cause +
         "), pairs do not wait for it: " +
         (late ? "raise guess_timeout_s = " + toText(timeout_s_) + ", or synchronise the clocks"
               : "correct guess_frame, or start the odometry that publishes it");
}

}  // namespace rotrocc
