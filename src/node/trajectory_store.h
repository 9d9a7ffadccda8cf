#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "evaluation/trajectory_file.h"
#include "input/log.h"
#include "rotrocc/trajectory.h"

namespace rotrocc {

/// The poses of the left camera: the latest in memory, to be saved, and with a path each one in a
/// file.
///
/// A thread of its own writes that file: a slow disk does not delay the odometry, and while it is
/// full, the latest poses wait for space. No file is replaced: a trajectory goes to the next number
/// that is free, as in poses.txt, poses_2.txt, poses_3.txt. Its stamps increase; a pose that is not
/// later than the one before it begins another file.
class TrajectoryStore {
 public:
  /// Keeps the latest `max_length` poses of a trajectory for save(). Allocates all memory at once,
  /// so that it cannot run out after hours. Without `path`, no file is written. Throws
  /// std::exception with one sentence if that cannot be a file, or on an unknown format.
  explicit TrajectoryStore(std::size_t max_length,
                           const std::string& path = "",
                           const std::string& format = "tum",
                           Log log = Log());
  /// Writes what still waits.
  ~TrajectoryStore();
  TrajectoryStore(const TrajectoryStore&) = delete;
  TrajectoryStore& operator=(const TrajectoryStore&) = delete;

  /// `starts`: it is the first pose of a trajectory. Does not wait for a disk, nor throw: errors of
  /// writing go to the log. If the disk is too slow or full for long, poses are left out of the
  /// file.
  void add(const StampedPose& pose, bool starts = false);

  /// Why poses wait, in one sentence; empty if they are written.
  std::string fault() const;

  /// Replaces a file by the poses of the present trajectory; `format` is "tum" or "kitti". add()
  /// waits while they are copied: some milliseconds for 100,000. Returns a sentence with the count
  /// and the path. Throws std::exception with one sentence if there are no poses or writing fails;
  /// the file is then as it was.
  std::string save(const std::string& path, const std::string& format) const;

 private:
  struct Item {
    StampedPose pose;
    std::uint64_t trajectory = 0;  // number
  };

  Trajectory present() const;
  void work();
  std::vector<Item> takeAll();
  void untilDone(const std::function<void()>& action);
  bool waitAfter(const std::exception& error);
  void write(const Item& item);
  void openNext();

  Log log_;
  std::size_t max_length_;
  std::string path_;
  TrajectoryFormat format_;
  Throttle left_out_warning_;

  mutable std::mutex mutex_;  // of what follows, up to the empty line
  std::condition_variable changed_;
  std::vector<Item> items_;  // ring buffer
  std::uint64_t added_ = 0;  // poses
  std::uint64_t taken_ = 0;  // by the thread, or left out
  std::uint64_t left_out_ = 0;
  std::uint64_t trajectory_ = 0;
  std::string fault_;
  bool closed_ = false;

  // Of the thread.
  std::optional<TrajectoryFile> file_;
  std::optional<Item> last_;
  int number_ = 0;

  std::thread thread_;
};

}  // namespace rotrocc
