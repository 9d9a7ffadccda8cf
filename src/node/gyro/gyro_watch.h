#pragma once

#include <string>

#include "node/patience.h"

namespace rotrocc {

/// Decides what the log says about a gyroscope, and whether pairs wait for it: not for one that has
/// been missing for a while, except now and then.
class GyroWatch {
 public:
  /// Pairs in a row after which the log tells that it is used or not, and why.
  static constexpr int kPairs = Patience::kMisses;
  /// While it is missing, one of so many pairs waits for it.
  static constexpr int kRetryPairs = 10;

  struct Message {
    bool is_warning = false;
    std::string text;  ///< empty: nothing to tell
  };

  /// What to tell after a pair. `why_not` is empty if the gyroscope predicted its rotation.
  Message onPair(const std::string& why_not);

  /// Whether the next pair waits for samples.
  bool waits() const { return patience_.waits(); }

 private:
  Patience patience_{kRetryPairs};
  int used_ = 0;  // pairs in a row
  bool told_used_ = false, told_missed_ = false;
};

}  // namespace rotrocc
