#include "node/trajectory/trajectory_history.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "evaluation/trajectory_file.h"

namespace rotrocc {

void TrajectoryHistory::add(const StampedPose& pose) {
  const std::lock_guard<std::mutex> lock(mutex_);
  poses_[next_] = pose;
  next_ = (next_ + 1) % poses_.size();
  size_ = std::min(size_ + 1, poses_.size());
}

void TrajectoryHistory::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  size_ = 0;
}

/// From the oldest to the latest.
Trajectory TrajectoryHistory::copy() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  Trajectory poses;
  poses.reserve(size_);
  const std::size_t first = next_ + poses_.size() - size_;
  for (std::size_t i = 0; i < size_; ++i) poses.push_back(poses_[(first + i) % poses_.size()]);
  return poses;
}

std::string TrajectoryHistory::save(const std::string& path, const std::string& format) const {
  if (path.empty()) throw std::invalid_argument("the path is empty: give an output file");
  const TrajectoryFormat file_format = trajectoryFormat(format);
  const Trajectory poses = copy();
  if (poses.empty()) throw std::runtime_error("there are no poses: no pair has been processed");
  const std::string absolute = std::filesystem::absolute(path).string();
  TrajectoryReplacement file(absolute, file_format);
  for (const StampedPose& pose : poses) file.add(pose);
  file.finish();
  return "wrote " + std::to_string(poses.size()) + " poses of the left camera to " + absolute;
}

}  // namespace rotrocc
