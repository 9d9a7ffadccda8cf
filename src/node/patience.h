#pragma once

#include <cstdint>

namespace rotrocc {

/// Whether pairs wait for another source of motion: not after several misses in a row, except now
/// and then.
class Patience {
 public:
  /// Misses in a row that end it.
  static constexpr int kMisses = 5;

  /// Once it has ended, one of `retry_pairs` pairs waits.
  explicit Patience(int retry_pairs) : retry_pairs_(static_cast<std::uint64_t>(retry_pairs)) {}

  void onAnswer() { misses_ = 0; }
  void onMiss() { ++misses_; }

  /// In a row.
  std::uint64_t misses() const { return misses_; }
  bool hasEnded() const { return misses_ >= kMisses; }

  /// Whether the next pair waits.
  bool waits() const { return !hasEnded() || misses_ % retry_pairs_ == 0; }

 private:
  std::uint64_t retry_pairs_;
  std::uint64_t misses_ = 0;
};

}  // namespace rotrocc
