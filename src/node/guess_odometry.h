#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <Eigen/Geometry>

namespace rotrocc {

/// Another odometry of the robot, as that of its wheels, that tf knows as the pose of the base in
/// its own odom frame, the guess frame.
class GuessOdometry {
 public:
  /// Waits at most `timeout_s` for the tf of a stamp.
  GuessOdometry(const std::string& guess_frame, const std::string& base_frame, double timeout_s);
  GuessOdometry(const GuessOdometry&) = delete;
  GuessOdometry& operator=(const GuessOdometry&) = delete;

  /// The motion of the base T_prev_cur between two stamps; nothing if tf does not know it in time.
  std::optional<Eigen::Isometry3d> motion(std::int64_t prev_ns, std::int64_t cur_ns) const;

  /// T_guess_base at a stamp, if tf knows it already.
  std::optional<Eigen::Isometry3d> pose(std::int64_t stamp_ns) const;

  const std::string& frame() const { return guess_frame_; }

  /// Forgets the tf of a time that is over.
  void clear() { buffer_.clear(); }

 private:
  std::string guess_frame_;
  std::string base_frame_;
  std::chrono::duration<double> timeout_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
};

}  // namespace rotrocc
