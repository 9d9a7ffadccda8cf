#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

#include "rotrocc/trajectory.h"

namespace rotrocc {

/// The poses of the left camera since the start, the last reset or the last jump of time, the
/// latest `max_length` of them. For any thread.
class TrajectoryHistory {
 public:
  /// Takes all its memory now: a robot shall not find out after hours that it is too much.
  explicit TrajectoryHistory(std::size_t max_length) : poses_(max_length) {}

  void add(const StampedPose& pose);
  void clear();

  /// Writes what there is; `format` is "tum" or "kitti". Returns a sentence on what was written
  /// where. Throws std::exception with one sentence if there is nothing to write, or no way to.
  std::string save(const std::string& path, const std::string& format) const;

 private:
  mutable std::mutex mutex_;
  std::vector<StampedPose> poses_;  // a ring
  std::size_t next_ = 0;            // place of the next pose
  std::size_t size_ = 0;
};

}  // namespace rotrocc
