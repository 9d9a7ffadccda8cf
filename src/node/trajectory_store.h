#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>

#include <boost/circular_buffer.hpp>

#include "input/log.h"
#include "rotrocc/trajectory.h"

namespace rotrocc {

/// The poses of the left camera, or of the base: the latest in memory, to be saved, and with a path
/// each one in a file.
///
/// No file is replaced by those of the path: a trajectory goes to the next number that is free, as
/// in poses.txt, poses_2.txt, poses_3.txt. Its stamps increase; a pose that is not later than the
/// one before it begins another file. Thread-safe.
class TrajectoryStore {
 public:
  /// Keeps the latest `max_length` poses of a trajectory for save(). Allocates all memory at once,
  /// so that it cannot run out after hours. Without `path`, no file is written. Throws
  /// std::exception with one sentence if that cannot be a file, or on an unknown format.
  explicit TrajectoryStore(std::size_t max_length,
                           const std::string& path = "",
                           const std::string& format = "tum",
                           const std::string& body = "the left camera",
                           Log log = Log());

  /// `starts`: it is the first pose of a trajectory. Does not throw: after an error of writing,
  /// which goes to the log, the file has no more poses of this trajectory.
  void add(const StampedPose& pose, bool starts = false);

  /// Why the file has no more poses, in one sentence; empty if it has.
  std::string fault() const;

  /// Replaces a file by the poses of the present trajectory; `format` is "tum" or "kitti". add()
  /// waits while they are copied. Returns a sentence with the count and the path. Throws
  /// std::exception with one sentence if there are no poses or writing fails; the file is then as
  /// it was.
  std::string save(const std::string& path, const std::string& format) const;

 private:
  Log log_;
  std::string path_;
  TrajectoryFormat format_;
  std::string body_;

  mutable std::mutex mutex_;  // of what follows
  boost::circular_buffer<StampedPose> poses_;
  std::optional<TrajectoryWriter> file_;
  int number_ = 0;  // of the file
  std::string fault_;
};

}  // namespace rotrocc
