#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include <tf2/buffer_core.h>
#include <Eigen/Geometry>

#include "input/log.h"
#include "node/waiting.h"

namespace rotrocc {

/// Where the pose of the base by another odometry is in tf.
struct GuessSource {
  std::string name;         ///< for messages: the parameter and its value
  std::string guess_frame;  ///< the odom frame of that odometry
  std::string base_frame;
  /// Why there is no pose, if that is known better than tf knows it; empty if not.
  std::function<std::string()> why_not = [] { return std::string(); };
};

/// Another odometry of the robot, e.g. wheel odometry, whose tf is the pose of the base in its own
/// odom frame, the guess frame.
///
/// Motions wait for tf. After SourceWatch::kPairs in a row they no longer do, until tf has the
/// transform again. Transforms that come, but late, are waited for once in kRetryPairs.
class GuessOdometry {
 public:
  static constexpr int kRetryPairs = 50;
  /// How long a pair waits: odometries publish at 20 Hz or more.
  static constexpr double kTimeout_s = 0.05;

  GuessOdometry(const tf2::BufferCore& tf, GuessSource source, Log log = Log());

  /// Motion of the base T_last_cur from the last pair to a later stamp, however long ago that is;
  /// nothing, and a miss, if tf does not have it in time.
  std::optional<Eigen::Isometry3d> motionTo(std::int64_t stamp_ns, const WaitFor& wait);

  /// The pair of this stamp is the last one. Returns T_guess_base then, if tf already has it.
  std::optional<Eigen::Isometry3d> moveTo(std::int64_t stamp_ns);

  /// Why motions no longer wait, with a remedy, in one sentence; empty if they do.
  const std::string& problem() const { return problem_; }
  std::uint64_t misses() const { return misses_; }

 private:
  std::optional<Eigen::Isometry3d> pose(std::int64_t stamp_ns) const;
  void observe(const std::optional<std::int64_t>& missing_ns);
  std::string describeMiss(std::int64_t stamp_ns) const;

  const tf2::BufferCore& tf_;
  Log log_;
  GuessSource source_;
  std::optional<std::int64_t> last_stamp_ns_;
  /// The pose at that stamp, as soon as tf has it: tf forgets it after 10 s.
  std::optional<Eigen::Isometry3d> T_guess_last_;
  std::string problem_;
  std::uint64_t misses_ = 0;
  SourceWatch watch_{kRetryPairs};
};

}  // namespace rotrocc
