#pragma once

#include <string>

#include "rotrocc/OdometryStatus.h"

namespace rotrocc {

/// Warns of a disparity bias or a row offset of the rig. What single pairs show may be wrong, so it
/// must last.
class RigWatch {
 public:
  /// Pairs with a motion, in a row, after which a fault is told.
  static constexpr int kPairs = 20;

  /// The faults that last, in one sentence with a remedy; empty if there are none. To be called
  /// with the status of each pair.
  std::string observe(const OdometryStatus& status);

 private:
  int bias_ = 0, rows_ = 0;  // pairs in a row
};

}  // namespace rotrocc
