#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <Eigen/Geometry>

namespace rotrocc {

/// Another odometry of the robot, e.g. wheel odometry, whose tf is the pose of the base in its own
/// odom frame, the guess frame.
class GuessOdometry {
 public:
  /// Waits at most `timeout_s` for a transform.
  GuessOdometry(const std::string& guess_frame, const std::string& base_frame, double timeout_s);
  GuessOdometry(const GuessOdometry&) = delete;
  GuessOdometry& operator=(const GuessOdometry&) = delete;

  /// Motion of the base T_prev_cur between two stamps; nothing if tf does not have it in time.
  std::optional<Eigen::Isometry3d> motion(std::int64_t prev_ns, std::int64_t cur_ns) const;

  /// T_guess_base at a stamp, if tf already has it.
  std::optional<Eigen::Isometry3d> pose(std::int64_t stamp_ns) const;

  const std::string& frame() const { return guess_frame_; }

  /// Discards transforms from before a time jump.
  void clear() { buffer_.clear(); }

 private:
  std::string guess_frame_;
  std::string base_frame_;
  std::chrono::duration<double> timeout_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
};

}  // namespace rotrocc
