#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "rotrocc/trajectory.h"

namespace rotrocc {

/// Throws std::runtime_error if `path` is neither free nor a regular file, because to open a FIFO
/// or to write to a device may take for ever, or if there can be no new files in its directory.
void requireFile(const std::string& path);

/// A new file of poses, written in large parts. It has whole lines only, even if writing fails.
class TrajectoryFile {
 public:
  /// Throws std::system_error if the file cannot be created; with std::errc::file_exists if there
  /// is one. `name`: of the file, in messages.
  TrajectoryFile(const std::string& path, TrajectoryFormat format, const std::string& name);
  ~TrajectoryFile();
  TrajectoryFile(const TrajectoryFile&) = delete;
  TrajectoryFile& operator=(const TrajectoryFile&) = delete;

  /// These throw std::system_error if writing fails, e.g. when the disk is full, and may be called
  /// again then: nothing is lost or written twice.
  void add(const StampedPose& pose);
  void flush();  ///< hands over all poses to the operating system
  void sync();   ///< waits until they are on the disk

 private:
  std::string name_;
  TrajectoryFormat format_;
  int descriptor_;
  std::string text_;  // not yet written
};

/// Replaces a file as a whole: until finish(), and if anything fails, it is as it was. A crash or a
/// power failure leaves the old or the new file.
class TrajectoryReplacement {
 public:
  /// Writes to a temporary file in the same directory. Throws std::runtime_error as requireFile(),
  /// or if a file cannot be written.
  TrajectoryReplacement(const std::string& path, TrajectoryFormat format);
  ~TrajectoryReplacement();

  /// These throw std::runtime_error if writing fails.
  void add(const StampedPose& pose) { file_->add(pose); }
  void finish();

 private:
  std::filesystem::path target_;
  std::string temporary_;
  std::optional<TrajectoryFile> file_;
};

}  // namespace rotrocc
