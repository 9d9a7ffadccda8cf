#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>

#include "evaluation/trajectory_file.h"
#include "input/log.h"
#include "node/trajectory/bounded_queue.h"
#include "rotrocc/trajectory.h"

namespace rotrocc {

/// The path of the file with that number: poses.txt, poses_2.txt, poses_3.txt, ...
std::string numberedPath(const std::string& path, int number);

/// Writes each pose to a file, in a thread of its own: a slow disk does not delay the odometry. No
/// file is replaced: a trajectory goes to the next number that is free. Its stamps increase; a pose
/// that is not later than the one before it begins another file.
class TrajectoryRecorder {
 public:
  /// Throws std::exception with one sentence if `path` cannot be a file, or on an unknown format.
  TrajectoryRecorder(const std::string& path, const std::string& format, Log log = Log());
  /// Writes what still waits.
  ~TrajectoryRecorder();
  TrajectoryRecorder(const TrajectoryRecorder&) = delete;
  TrajectoryRecorder& operator=(const TrajectoryRecorder&) = delete;

  /// Neither waits nor throws: errors of writing go to the log. If the disk is too slow for long,
  /// poses are left out. Call in one thread, as beginNew().
  void add(const StampedPose& pose);

  /// The next pose begins another file.
  void beginNew() { begins_ = true; }

 private:
  struct Item {
    StampedPose pose;
    bool begins = false;
  };

  void work();
  void write(const Item& item);
  void openNext();
  void fail(const std::exception& error);

  Log log_;
  std::string path_;
  TrajectoryFormat format_;
  BoundedQueue<Item> queue_;

  // Of the caller.
  bool begins_ = true;
  std::size_t left_out_ = 0;
  Throttle left_out_warning_{std::chrono::seconds(5)};

  // Of the thread.
  std::optional<TrajectoryFile> file_;  // none after an error
  std::int64_t last_stamp_ns_ = 0;
  int number_ = 0;

  std::thread thread_;
};

}  // namespace rotrocc
