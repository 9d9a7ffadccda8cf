#pragma once

#include <optional>
#include <string>
#include <thread>

#include "input/latest_mailbox.h"
#include "input/log.h"
#include "node/base/base_odometry.h"

namespace rotrocc {

/// Stamp, pose and twist that a PoseFile has written; none, with a line in the log, if there is no
/// such file or it is damaged or of another odom frame. Throws std::runtime_error with one sentence
/// if it is another file, which a PoseFile would replace.
std::optional<BaseState> readPoseFile(const std::string& path,
                                      const std::string& odom_frame,
                                      const Log& log);

/// Keeps the latest pose of the base in a file. It has one line of constant length, which is
/// replaced in place, so that it is whole if the process is killed, and a full disk does not
/// matter. A thread of its own writes it: a slow disk does not delay the odometry.
class PoseFile {
 public:
  /// Throws std::exception with one sentence if `path` cannot be such a file.
  PoseFile(const std::string& path, std::string odom_frame, Log log);
  /// Writes what still waits.
  ~PoseFile();
  PoseFile(const PoseFile&) = delete;
  PoseFile& operator=(const PoseFile&) = delete;

  /// For one thread. Errors of writing go to the log.
  void put(const BaseState& state);

 private:
  void work();
  void write(const BaseState& state);

  std::string path_;
  std::string odom_frame_;
  Log log_;
  int descriptor_;
  std::optional<BaseState> last_;
  Throttle warning_{std::chrono::minutes(1)};
  LatestMailbox<BaseState> mailbox_;
  std::thread thread_;
};

}  // namespace rotrocc
