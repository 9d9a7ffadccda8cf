#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>

namespace rotrocc {

/// Hands the latest item of a producer to a consumer in another thread, however slow that is.
template <class Item>
class LatestMailbox {
 public:
  /// Replaces the item that nobody has taken yet.
  void put(Item item) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (item_) ++replaced_;
    item_ = std::move(item);
    changed_.notify_one();
  }

  /// Waits for an item. Nothing if none comes in time, or the mailbox is closed.
  std::optional<Item> take(std::chrono::milliseconds timeout) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_for(lock, timeout, [this] { return item_ || closed_; });
    if (closed_) return std::nullopt;
    return std::exchange(item_, std::nullopt);
  }

  /// Ends all waiting, for good.
  void close() {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

  bool closed() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return closed_;
  }

  /// Items that were never taken, as a newer one came.
  std::uint64_t replaced() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return replaced_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Item> item_;
  bool closed_ = false;
  std::uint64_t replaced_ = 0;
};

}  // namespace rotrocc
