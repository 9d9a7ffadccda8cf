#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

namespace rotrocc {

/// Passes the latest item of a producer to a slower consumer in another thread.
template <class Item>
class LatestMailbox {
 public:
  /// Replaces an item that was not taken yet. Returns whether there was one.
  bool put(Item item) {
    std::unique_lock<std::mutex> lock(mutex_);
    const bool replaced = item_.has_value();
    item_ = std::move(item);
    lock.unlock();  // or the consumer would wake only to wait for it
    changed_.notify_one();
    return replaced;
  }

  /// Waits for an item. Returns nothing on timeout or if the mailbox is closed.
  std::optional<Item> take(std::chrono::milliseconds timeout) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_for(lock, timeout, [this] { return item_ || closed_; });
    if (closed_) return std::nullopt;
    return std::exchange(item_, std::nullopt);
  }

  bool hasItem() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return item_.has_value();
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
  std::optional<Item> item_;
  bool closed_ = false;
};

}  // namespace rotrocc
