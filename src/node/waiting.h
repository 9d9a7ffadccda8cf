#pragma once

#include <functional>
#include <optional>

namespace rotrocc {

/// Waits until a condition holds, at most for a time; returns whether it does.
using WaitFor = std::function<bool(double limit_s, const std::function<bool()>& condition)>;

/// Whether pairs wait for another source of motion, and the log says that it is used: after several
/// misses in a row pairs wait only now and then.
class SourceWatch {
 public:
  /// Hits or misses in a row that count.
  static constexpr int kPairs = 5;

  /// While it is missing, one of `retry_pairs` pairs waits.
  explicit SourceWatch(int retry_pairs) : retry_pairs_(retry_pairs) {}

  /// Returns whether that is to be logged: it is there, or missing, for long enough.
  bool observe(bool hit) {
    in_a_row_ = hit == was_hit_ ? in_a_row_ + 1 : 1;
    was_hit_ = hit;
    if (in_a_row_ < kPairs || logged_ == hit) return false;
    logged_ = hit;
    return true;
  }

  bool isMissing() const { return !was_hit_ && in_a_row_ >= kPairs; }

  /// Whether the next pair waits.
  bool waits() const { return !isMissing() || in_a_row_ % retry_pairs_ == 0; }

 private:
  int retry_pairs_;
  int in_a_row_ = 0;  // hits or misses
  bool was_hit_ = false;
  std::optional<bool> logged_;
};

}  // namespace rotrocc
