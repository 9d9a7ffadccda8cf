#include "trajectory_history.h"

#include <filesystem>
#include <stdexcept>

namespace rotrocc {

void TrajectoryHistory::add(const StampedPose& pose) {
  const std::lock_guard<std::mutex> lock(mutex_);
  poses_.push_back(pose);
  if (poses_.size() > max_length_) poses_.pop_front();
}

void TrajectoryHistory::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  poses_.clear();
}

std::string TrajectoryHistory::save(const std::string& path, const std::string& format) const {
  if (path.empty()) throw std::invalid_argument("the path is empty: name a file to write");
  const TrajectoryFormat file_format = trajectoryFormat(format);
  std::deque<StampedPose> poses;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    poses = poses_;
  }
  if (poses.empty()) throw std::runtime_error("there is no pose yet: no pair has been processed");
  const std::string absolute = std::filesystem::absolute(path).string();
  TrajectoryWriter writer(absolute, file_format);
  for (const StampedPose& pose : poses) writer.write(pose);
  return "wrote " + std::to_string(poses.size()) + " poses of the left camera to " + absolute;
}

}  // namespace rotrocc
