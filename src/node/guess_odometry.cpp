#include "node/guess_odometry.h"

#include <thread>

#include <ros/init.h>

#include "input/message_conversion.h"
#include "node/camera_mount.h"

namespace rotrocc {
namespace {

constexpr std::chrono::milliseconds kPoll(2);

}  // namespace

GuessOdometry::GuessOdometry(const std::string& guess_frame,
                             const std::string& base_frame,
                             double timeout_s)
    : guess_frame_(guess_frame), base_frame_(base_frame), timeout_(timeout_s), listener_(buffer_) {}

std::optional<Eigen::Isometry3d> GuessOdometry::motion(std::int64_t prev_ns,
                                                       std::int64_t cur_ns) const {
  // In real time: ROS time may stand still.
  const auto deadline = std::chrono::steady_clock::now() + timeout_;
  auto current = pose(cur_ns);
  while (!current && ros::ok() && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(kPoll);
    current = pose(cur_ns);
  }
  const auto previous = pose(prev_ns);
  if (!current || !previous) return std::nullopt;
  return previous->inverse() * *current;
}

std::optional<Eigen::Isometry3d> GuessOdometry::pose(std::int64_t stamp_ns) const {
  try {
    return toEigen(
        buffer_.lookupTransform(guess_frame_, base_frame_, toRosTime(stamp_ns)).transform);
  } catch (const std::exception&) {
    return std::nullopt;  // not available: the previous motion is the prediction
  }
}

}  // namespace rotrocc
