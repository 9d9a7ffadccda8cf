#pragma once

#include <cstddef>
#include <vector>

namespace rotrocc {

/// How far the rows of the right image are below those of the left one that show the same.
/// Rectification should make it nothing; a right camera that is pitched or rolled, or whose lens is
/// not as calibrated, does not.
struct RowOffset {
  double median_px = 0.0;   ///< over the features of the last pairs; 0 before the first
  double sigma_px = 0.0;    ///< standard deviation of the median, features taken as independent
  double typical_px = 0.0;  ///< median of the absolute differences: how far rows are apart
};

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
