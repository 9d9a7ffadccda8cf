#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <utility>
#include <vector>

namespace rotrocc {

/// Passes items to a consumer in another thread, which may be slow: the producer never waits.
template <class Item>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t max_size) : max_size_(max_size) {}

  /// Returns false, and leaves the item out, if as many wait already as may.
  bool put(Item item) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (items_.size() >= max_size_) return false;
    items_.push_back(std::move(item));
    changed_.notify_one();
    return true;
  }

  /// Waits for items and takes all. Returns none if the queue is closed and empty.
  std::vector<Item> takeAll() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return !items_.empty() || closed_; });
    return std::exchange(items_, {});
  }

  /// No more items will come.
  void close() {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  std::size_t max_size_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Item> items_;
  bool closed_ = false;
};

}  // namespace rotrocc
