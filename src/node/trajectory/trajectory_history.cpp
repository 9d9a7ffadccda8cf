#include "node/trajectory/trajectory_history.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <stdexcept>

#include "evaluation/trajectory_file.h"

namespace rotrocc {
namespace {

constexpr std::size_t kBlock = 512;  // poses

}  // namespace

/// One block more than the poses fill, because the oldest is rarely at the begin of a block.
TrajectoryHistory::TrajectoryHistory(std::size_t max_length)
    : max_length_(max_length), blocks_((max_length + kBlock - 1) / kBlock + 1) {
  for (auto& block : blocks_) block = std::make_shared<Block>(kBlock);
}

std::size_t TrajectoryHistory::blockOf(std::size_t index) const {
  return index / kBlock % blocks_.size();
}

void TrajectoryHistory::add(const StampedPose& pose) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::shared_ptr<Block>& block = blocks_[blockOf(next_)];
  // Another block if this one is being saved.
  if (next_ % kBlock == 0 && block.use_count() > 1) block = std::make_shared<Block>(kBlock);
  std::atomic_thread_fence(std::memory_order_acquire);  // after the last read of a save
  (*block)[next_ % kBlock] = pose;
  ++next_;
  first_ = std::max(first_, next_ - std::min(next_, max_length_));
}

void TrajectoryHistory::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  next_ = (next_ + kBlock - 1) / kBlock * kBlock;
  first_ = next_;
}

std::vector<TrajectoryHistory::Stretch> TrajectoryHistory::snapshot() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<Stretch> stretches;
  for (std::size_t begin = first_; begin < next_;) {
    const std::size_t start = begin / kBlock * kBlock;
    const std::size_t end = std::min(next_, start + kBlock);
    stretches.push_back({blocks_[blockOf(begin)], begin - start, end - start});
    begin = end;
  }
  return stretches;
}

std::string TrajectoryHistory::save(const std::string& path, const std::string& format) const {
  if (path.empty()) throw std::invalid_argument("the path is empty: give an output file");
  const TrajectoryFormat file_format = trajectoryFormat(format);
  const std::vector<Stretch> stretches = snapshot();
  if (stretches.empty()) throw std::runtime_error("there are no poses: no pair has been processed");
  const std::string absolute = std::filesystem::absolute(path).string();
  TrajectoryReplacement file(absolute, file_format);
  std::size_t count = 0;
  for (const Stretch& stretch : stretches) {
    for (std::size_t i = stretch.begin; i < stretch.end; ++i) file.add((*stretch.block)[i]);
    count += stretch.end - stretch.begin;
  }
  file.finish();
  return "wrote " + std::to_string(count) + " poses of the left camera to " + absolute;
}

}  // namespace rotrocc
