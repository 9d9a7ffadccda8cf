#include "node/trajectory_store.h"

#include <unistd.h>

#include <cerrno>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace rotrocc {
namespace {

/// Throws std::runtime_error if `path` is neither free nor a regular file, because to open a FIFO
/// or to write to a device may take for ever, or if there can be no new files in its directory.
void requireFile(const std::string& path) {
  const std::filesystem::file_status status = std::filesystem::status(path);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw std::runtime_error("cannot write " + path + ": it is not a file; give a file name");
  }
  const std::filesystem::path directory = std::filesystem::path(path).parent_path();
  if (::access(directory.c_str(), W_OK | X_OK) == 0) return;
  throw std::system_error(
      errno, std::generic_category(), "cannot write " + path + " into its directory");
}

std::string numberedPath(const std::string& path, int number) {
  if (number == 1) return path;
  std::filesystem::path numbered(path);
  const std::string name =
      numbered.stem().string() + "_" + std::to_string(number) + numbered.extension().string();
  return numbered.replace_filename(name).string();
}

}  // namespace

TrajectoryStore::TrajectoryStore(std::size_t max_length,
                                 const std::string& path,
                                 const std::string& format,
                                 const std::string& body,
                                 Log log)
    : log_(std::move(log)),
      path_(path.empty() ? "" : std::filesystem::absolute(path).string()),
      format_(trajectoryFormat(format)),
      body_(body),
      poses_(max_length) {
  // A wrong path is rejected at the start; the file comes with the first pose, as one without is
  // invalid.
  if (!path_.empty()) requireFile(path_);
}

void TrajectoryStore::add(const StampedPose& pose, bool starts) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool goes_back = !poses_.empty() && pose.stamp_ns <= poses_.back().stamp_ns;
  if (starts) poses_.clear();
  poses_.push_back(pose);
  if (path_.empty()) return;
  if (starts || goes_back) {
    file_.reset();
    fault_.clear();
  }
  if (!fault_.empty()) return;
  try {
    if (!file_) {
      std::string path;
      do path = numberedPath(path_, ++number_);
      while (std::filesystem::exists(path));
      file_.emplace(path, format_, body_);
      log_.info("trajectory file: " + path);
    }
    file_->write(pose);
  } catch (const std::exception& error) {
    fault_ = error.what();
    log_.error("trajectory file: " + fault_ +
               "; the rest of this trajectory is not in it: make space, and call ~save_trajectory");
  }
}

std::string TrajectoryStore::fault() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return fault_;
}

std::string TrajectoryStore::save(const std::string& path, const std::string& format) const {
  if (path.empty()) throw std::invalid_argument("the path is empty: give an output file");
  const TrajectoryFormat file_format = trajectoryFormat(format);
  const auto poses = [this] {
    const std::lock_guard<std::mutex> lock(mutex_);
    return poses_;
  }();
  if (poses.empty()) throw std::runtime_error("there are no poses: no pair has been processed");
  const std::string absolute = std::filesystem::absolute(path).string();
  requireFile(absolute);
  const std::string temporary = absolute + ".tmp";
  try {
    TrajectoryWriter file(temporary, file_format, body_);
    for (const StampedPose& pose : poses) file.write(pose);
    std::filesystem::rename(temporary, absolute);
  } catch (const std::exception&) {
    std::filesystem::remove(temporary);
    throw;
  }
  return "wrote " + std::to_string(poses.size()) + " poses of " + body_ + " to " + absolute;
}

}  // namespace rotrocc
