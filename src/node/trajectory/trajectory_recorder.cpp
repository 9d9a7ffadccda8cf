#include "node/trajectory/trajectory_recorder.h"

#include <pthread.h>

#include <exception>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

namespace rotrocc {
namespace {

/// Many minutes of a drive, in some megabytes.
constexpr std::size_t kMaxWaiting = 10'000;

}  // namespace

std::string numberedPath(const std::string& path, int number) {
  if (number == 1) return path;
  std::filesystem::path numbered(path);
  const std::string name =
      numbered.stem().string() + "_" + std::to_string(number) + numbered.extension().string();
  return numbered.replace_filename(name).string();
}

TrajectoryRecorder::TrajectoryRecorder(const std::string& path, const std::string& format, Log log)
    : log_(std::move(log)),
      path_(std::filesystem::absolute(path).string()),
      format_(trajectoryFormat(format)),
      queue_(kMaxWaiting) {
  // Refuses a wrong path at the start; the file comes with the first pose, as one without is
  // invalid.
  requireFile(path_);
  thread_ = std::thread(&TrajectoryRecorder::work, this);
}

TrajectoryRecorder::~TrajectoryRecorder() {
  queue_.close();
  thread_.join();
}

void TrajectoryRecorder::add(const StampedPose& pose) {
  if (queue_.put({pose, begins_})) {
    begins_ = false;
    return;
  }
  ++left_out_;
  if (!left_out_warning_.pass()) return;
  log_.warn("trajectory file: the disk of " + path_ + " is too slow, " + std::to_string(left_out_) +
            " poses so far are left out");
}

void TrajectoryRecorder::work() {
  pthread_setname_np(pthread_self(), "odometry_file");  // for `top -H` and debuggers
  for (;;) {
    const std::vector<Item> items = queue_.takeAll();
    if (items.empty()) return;
    for (const Item& item : items) write(item);
    try {
      if (file_) file_->flush();
    } catch (const std::exception& error) {
      fail(error);
    }
  }
}

void TrajectoryRecorder::write(const Item& item) {
  try {
    if (item.begins || item.pose.stamp_ns <= last_stamp_ns_) openNext();
    if (file_) file_->add(item.pose);
  } catch (const std::exception& error) {
    fail(error);
  }
  last_stamp_ns_ = item.pose.stamp_ns;
}

void TrajectoryRecorder::openNext() {
  if (file_) file_->flush();
  file_.reset();
  for (;;) {
    const std::string path = numberedPath(path_, ++number_);
    try {
      file_.emplace(path, format_, path);
      log_.info("trajectory file: " + path);
      return;
    } catch (const std::system_error& error) {
      if (error.code() != std::errc::file_exists) throw;
    }
  }
}

void TrajectoryRecorder::fail(const std::exception& error) {
  log_.error(std::string("trajectory file closed: ") + error.what());
  file_.reset();
}

}  // namespace rotrocc
