#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "rotrocc/trajectory.h"

namespace rotrocc {

/// The poses of the left camera since the start, the last reset or the last time jump, at most the
/// latest `max_length`. Thread-safe; a save does not delay add().
class TrajectoryHistory {
 public:
  /// Allocates all memory at once, so that it cannot run out after hours.
  explicit TrajectoryHistory(std::size_t max_length);

  void add(const StampedPose& pose);
  void clear();

  /// Replaces the file as a whole; `format` is "tum" or "kitti". Returns a sentence with the count
  /// and the path. Throws std::exception with one sentence if there are no poses or writing fails;
  /// the file is then as it was.
  std::string save(const std::string& path, const std::string& format) const;

 private:
  using Block = std::vector<StampedPose>;
  /// Poses of a block; nobody changes these any more.
  struct Stretch {
    std::shared_ptr<const Block> block;
    std::size_t begin = 0, end = 0;
  };

  std::size_t blockOf(std::size_t index) const;
  std::vector<Stretch> snapshot() const;

  std::size_t max_length_;
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<Block>> blocks_;  // ring buffer
  // Indices count all poses; blocks begin at multiples of their size.
  std::size_t first_ = 0;
  std::size_t next_ = 0;
};

}  // namespace rotrocc
