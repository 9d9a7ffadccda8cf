#include "node/trajectory_store.h"

#include <pthread.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace rotrocc {
namespace {

/// Poses that may wait for the disk: many minutes of a drive, in some megabytes.
constexpr std::size_t kMaxWaiting = 10'000;
/// Of them, taken at once: add() waits for that.
constexpr std::uint64_t kMaxTaken = 1000;

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
                                 Log log)
    : log_(std::move(log)),
      max_length_(max_length),
      path_(path.empty() ? "" : std::filesystem::absolute(path).string()),
      format_(trajectoryFormat(format)),
      items_(path.empty() ? max_length : std::max(max_length, kMaxWaiting)) {
  if (path_.empty()) return;
  // Refuses a wrong path at the start; the file comes with the first pose, as one without is
  // invalid.
  requireFile(path_);
  thread_ = std::thread(&TrajectoryStore::work, this);
}

TrajectoryStore::~TrajectoryStore() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void TrajectoryStore::add(const StampedPose& pose, bool starts) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (starts) ++trajectory_;
  const bool leaves_out = !path_.empty() && added_ - taken_ == items_.size();
  if (leaves_out) {
    ++taken_;
    ++left_out_;
  }
  items_[added_++ % items_.size()] = {pose, trajectory_};
  const std::uint64_t left_out = left_out_;
  const bool is_told = !fault_.empty();
  lock.unlock();
  changed_.notify_one();
  if (!leaves_out || is_told || !left_out_warning_.pass()) return;
  log_.warn("trajectory file: the disk of " + path_ + " is too slow, " + std::to_string(left_out) +
            " poses so far are left out");
}

std::string TrajectoryStore::fault() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return fault_;
}

Trajectory TrajectoryStore::present() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  Trajectory poses;
  for (auto i = added_ - std::min<std::uint64_t>(added_, max_length_); i < added_; ++i) {
    const Item& item = items_[i % items_.size()];
    if (item.trajectory == trajectory_) poses.push_back(item.pose);
  }
  return poses;
}

std::string TrajectoryStore::save(const std::string& path, const std::string& format) const {
  if (path.empty()) throw std::invalid_argument("the path is empty: give an output file");
  const TrajectoryFormat file_format = trajectoryFormat(format);
  const Trajectory poses = present();
  if (poses.empty()) throw std::runtime_error("there are no poses: no pair has been processed");
  const std::string absolute = std::filesystem::absolute(path).string();
  TrajectoryReplacement file(absolute, file_format);
  for (const StampedPose& pose : poses) file.add(pose);
  file.finish();
  return "wrote " + std::to_string(poses.size()) + " poses of the left camera to " + absolute;
}

void TrajectoryStore::work() {
  pthread_setname_np(pthread_self(), "odometry_file");  // for `top -H` and debuggers
  for (;;) {
    const std::vector<Item> items = takeAll();
    if (items.empty()) break;
    for (const Item& item : items) untilDone([&] { write(item); });
    untilDone([&] {
      if (file_) file_->flush();
    });
  }
  const std::string why = fault();
  if (!why.empty()) log_.error("trajectory file: its end is lost: " + why);
}

/// Tries again after errors, until the store is closed.
void TrajectoryStore::untilDone(const std::function<void()>& action) {
  for (;;) {
    try {
      action();
      break;
    } catch (const std::exception& error) {
      if (!waitAfter(error)) return;
    }
  }
  std::unique_lock<std::mutex> lock(mutex_);
  if (std::exchange(fault_, "").empty()) return;
  const std::uint64_t left_out = left_out_;
  lock.unlock();
  log_.info("trajectory file: written again, " + std::to_string(left_out) +
            " poses so far are left out");
}

/// Returns whether to try again.
bool TrajectoryStore::waitAfter(const std::exception& error) {
  constexpr std::chrono::seconds kRetry(1);
  std::unique_lock<std::mutex> lock(mutex_);
  if (std::exchange(fault_, error.what()).empty()) {
    lock.unlock();
    log_.error(std::string("trajectory file: ") + error.what() +
               "; the latest poses wait until it can be written");
    lock.lock();
  }
  return !changed_.wait_for(lock, kRetry, [this] { return closed_; });
}

/// Waits for poses; none if there will be no more.
std::vector<TrajectoryStore::Item> TrajectoryStore::takeAll() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return taken_ < added_ || closed_; });
  const std::uint64_t end = std::min(added_, taken_ + kMaxTaken);
  std::vector<Item> items;
  items.reserve(end - taken_);
  for (; taken_ < end; ++taken_) items.push_back(items_[taken_ % items_.size()]);
  return items;
}

void TrajectoryStore::write(const Item& item) {
  const bool begins = !file_ || !last_ || item.trajectory != last_->trajectory ||
                      item.pose.stamp_ns <= last_->pose.stamp_ns;
  if (begins) openNext();
  file_->add(item.pose);
  last_ = item;
}

void TrajectoryStore::openNext() {
  if (file_) file_->flush();
  for (int number = number_ + 1;; ++number) {
    const std::string path = numberedPath(path_, number);
    try {
      file_.emplace(path, format_, path);
      number_ = number;
      log_.info("trajectory file: " + path);
      return;
    } catch (const std::system_error& error) {
      if (error.code() != std::errc::file_exists) throw;
    }
  }
}

}  // namespace rotrocc
