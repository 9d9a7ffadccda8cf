#pragma once

#include <cstddef>
#include <vector>

#include "rotrocc/odometry_result.h"

namespace rotrocc {

/// Estimates the RowOffset from single features, some of which are outliers.
class RowComparison {
 public:
  RowComparison();

  const RowOffset& offset() const { return offset_; }

  /// Adds the vertical offsets of single features [px], positive if lower in the right image.
  void observe(const std::vector<float>& differences_px);

  /// Discards all data, for use with another camera.
  void reset();

 private:
  RowOffset offset_;
  std::vector<float> last_px_;  // the last offsets, a ring buffer once it is full
  std::size_t oldest_ = 0;      // the entry that is overwritten next
  std::vector<float> sorted_px_;
};

}  // namespace rotrocc
