#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <tf2/buffer_core.h>
#include <Eigen/Geometry>

#include "input/log.h"
#include "node/miss_backoff.h"
#include "node/tf/tf_feed.h"

namespace rotrocc {

/// Another odometry of the robot, e.g. wheel odometry, whose tf is the pose of the base in its own
/// odom frame, the guess frame.
///
/// Motions wait for tf. After MissBackoff::kMisses in a row they no longer do, until tf has the
/// transform again. Transforms that come, but late, are waited for once in kRetryPairs.
class GuessOdometry {
 public:
  static constexpr int kRetryPairs = 50;

  /// Waits at most `timeout_s` for a transform.
  GuessOdometry(const std::string& guess_frame,
                const std::string& base_frame,
                double timeout_s,
                const TfFeed& feed = listenToTf,
                Log log = Log());
  GuessOdometry(const GuessOdometry&) = delete;
  GuessOdometry& operator=(const GuessOdometry&) = delete;

  /// Motion of the base T_last_cur from the last pair to a later stamp, however long ago that is;
  /// nothing, and a miss, if tf does not have it in time.
  std::optional<Eigen::Isometry3d> motionTo(std::int64_t stamp_ns);

  /// The pair of this stamp is the last one. Returns T_guess_base then, if tf already has it. With
  /// `starts_trajectory` time may have jumped: transforms from before are discarded.
  std::optional<Eigen::Isometry3d> moveTo(std::int64_t stamp_ns, bool starts_trajectory = false);

  /// Why motions no longer wait, with a remedy, in one sentence; empty if they do.
  const std::string& trouble() const { return trouble_; }
  std::uint64_t misses() const { return misses_; }

 private:
  std::optional<Eigen::Isometry3d> pose(std::int64_t stamp_ns) const;
  void onMiss(std::int64_t stamp_ns);
  void onMotion();
  std::string describeMiss(std::int64_t stamp_ns) const;

  Log log_;
  std::string guess_frame_;
  std::string base_frame_;
  double timeout_s_;
  std::optional<std::int64_t> last_stamp_ns_;
  /// The pose at that stamp, as soon as tf has it: tf forgets it after 10 s.
  std::optional<Eigen::Isometry3d> T_guess_last_;
  std::string trouble_;
  std::uint64_t misses_ = 0;
  MissBackoff backoff_{kRetryPairs};
  tf2::BufferCore buffer_;
  std::shared_ptr<void> listener_;
};

}  // namespace rotrocc
