#pragma once

#include <cstddef>
#include <vector>

#include "rotrocc/odometry_result.h"

namespace rotrocc {

/// Finds the RowOffset from single features, some of which are measured wrongly.
class RowComparison {
 public:
  RowComparison();

  const RowOffset& offset() const { return offset_; }

  /// Takes how far single features are lower in the right image [px].
  void observe(const std::vector<float>& differences_px);

  /// Forgets everything: the camera is another one.
  void reset();

 private:
  RowOffset offset_;
  std::vector<float> last_px_;  // a ring ...
  std::size_t oldest_ = 0;      // ... once it is full
  std::vector<float> sorted_px_;
};

}  // namespace rotrocc
