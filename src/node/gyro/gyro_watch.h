#pragma once

#include "node/miss_backoff.h"

namespace rotrocc {

/// Decides when the log reports that a gyroscope is used or not, and whether pairs wait for its
/// samples: not for those of one that has been missing for a while, except now and then.
class GyroWatch {
 public:
  /// Pairs in a row after which the log reports that it is used or not.
  static constexpr int kPairs = MissBackoff::kMisses;
  /// While it is missing, one of so many pairs waits for it.
  static constexpr int kRetryPairs = 10;

  /// Call after each pair. Returns whether to tell that it is used, or that it is not.
  bool tellsOf(bool used) {
    used ? backoff_.onHit() : backoff_.onMiss();
    in_a_row_ = used == was_used_ ? in_a_row_ + 1 : 1;
    was_used_ = used;
    const int change = used ? 1 : -1;
    if (in_a_row_ < kPairs || told_ == change) return false;
    told_ = change;
    return true;
  }

  /// Whether the next pair waits for samples.
  bool waits() const { return backoff_.waits(); }

 private:
  MissBackoff backoff_{kRetryPairs};
  bool was_used_ = false;
  int in_a_row_ = 0;  // pairs
  int told_ = 0;      // 1: used, -1: not used
};

}  // namespace rotrocc
