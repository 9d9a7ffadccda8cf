#pragma once

#include <cstddef>
#include <mutex>
#include <string>

#include "rotrocc/trajectory.h"

namespace rotrocc {

/// The poses of the left camera since the start, the last reset or the last time jump, at most the
/// latest `max_length`. Thread-safe; add() waits while a save copies the poses, but not while it
/// writes them.
class TrajectoryHistory {
 public:
  /// Allocates all memory at once, so that it cannot run out after hours.
  explicit TrajectoryHistory(std::size_t max_length) : poses_(max_length) {}

  void add(const StampedPose& pose);
  void clear();

  /// Replaces the file as a whole; `format` is "tum" or "kitti". Returns a sentence with the count
  /// and the path. Throws std::exception with one sentence if there are no poses or writing fails;
  /// the file is then as it was.
  std::string save(const std::string& path, const std::string& format) const;

 private:
  Trajectory copy() const;

  mutable std::mutex mutex_;
  Trajectory poses_;  // ring buffer
  std::size_t size_ = 0;
  std::size_t next_ = 0;  // index in the ring
};

}  // namespace rotrocc
