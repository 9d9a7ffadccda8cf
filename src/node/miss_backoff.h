#pragma once

#include <cstdint>

namespace rotrocc {

/// Whether pairs wait for another source of motion: after several misses in a row only now and
/// then.
class MissBackoff {
 public:
  /// Misses in a row after which it begins.
  static constexpr int kMisses = 5;

  /// From then on, one of `retry_pairs` pairs waits.
  explicit MissBackoff(int retry_pairs) : retry_pairs_(static_cast<std::uint64_t>(retry_pairs)) {}

  void onHit() { misses_ = 0; }
  void onMiss() { ++misses_; }

  /// In a row.
  std::uint64_t misses() const { return misses_; }
  bool hasBegun() const { return misses_ >= kMisses; }

  /// Whether the next pair waits.
  bool waits() const { return !hasBegun() || misses_ % retry_pairs_ == 0; }

 private:
  std::uint64_t retry_pairs_;
  std::uint64_t misses_ = 0;
};

}  // namespace rotrocc
