#pragma once

#include <cstddef>
#include <deque>
#include <mutex>
#include <string>

#include "rotrocc/trajectory.h"

namespace rotrocc {

/// The poses of the left camera since the start, the last reset or the last jump of time, the
/// latest `max_length` of them. For any thread.
class TrajectoryHistory {
 public:
  explicit TrajectoryHistory(std::size_t max_length) : max_length_(max_length) {}

  void add(const StampedPose& pose);
  void clear();

  /// Writes what there is; `format` is "tum" or "kitti". Returns a sentence on what was written
  /// where. Throws std::exception with one sentence if there is nothing to write, or no way to.
  std::string save(const std::string& path, const std::string& format) const;

 private:
  std::size_t max_length_;
  mutable std::mutex mutex_;
  std::deque<StampedPose> poses_;
};

}  // namespace rotrocc
