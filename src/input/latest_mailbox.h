#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace rotrocc {

/// Passes the latest item of a producer to a slower consumer in another thread.
template <class Item>
class LatestMailbox {
 public:
  /// Replaces items that were not taken yet, unless it came together with the previous one. Returns
  /// how many it replaced.
  std::size_t put(Item item, bool is_together = false) {
    std::unique_lock<std::mutex> lock(mutex_);
    const std::size_t replaced = is_together ? 0 : items_.size();
    if (!is_together) items_.clear();
    items_.push_back(std::move(item));
    lock.unlock();  // or the consumer would wake only to wait for it
    changed_.notify_one();
    return replaced;
  }

  /// Waits for an item. Returns nothing on timeout or if the mailbox is closed.
  std::optional<Item> take(std::chrono::milliseconds timeout) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_for(lock, timeout, [this] { return !items_.empty() || closed_; });
    if (closed_ || items_.empty()) return std::nullopt;
    std::optional<Item> item = std::move(items_.front());
    items_.pop_front();
    return item;
  }

  bool hasItem() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return !items_.empty();
  }

  /// Ends all current and future waits.
  void close() {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

  bool closed() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return closed_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> items_;  // the latest one, or those that came together
  bool closed_ = false;
};

}  // namespace rotrocc
