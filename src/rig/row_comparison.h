#pragma once

#include <vector>

#include <boost/circular_buffer.hpp>

#include "rotrocc/odometry_result.h"

namespace rotrocc {

/// Estimates the RowOffset from single features, many of which may be chance matches, and decides
/// what is corrected. Not an offset that is small, or smaller than the scatter of the features:
/// that is no constant. A correction ends at half of that, so it does not come and go with the
/// noise.
class RowComparison {
 public:
  RowComparison();

  const RowOffset& offset() const { return offset_; }

  /// Adds the vertical offsets of single features [px], positive if lower in the right image.
  void observe(const std::vector<float>& differences_px);

  /// Whether the features are enough to separate a notable offset from none. Until they are,
  /// features must have been searched in several rows, or near an offset to which isNear() applies.
  /// Near a wrong one, only those are found that seem to agree with it.
  bool isKnown() const;

  /// Whether the median is within half a row of `offset_px`.
  bool isNear(double offset_px) const;

  /// The rig may have been moved: a known offset is measured anew, and its correction stays until
  /// then.
  void searchAgain();

  /// Pixels become so many times as small, as in an enlarged image.
  void scale(double factor);

 private:
  RowOffset offset_;
  boost::circular_buffer<float> last_px_;
  std::vector<float> kept_px_;       // of these, without chance matches
  std::vector<float> distances_px_;  // buffer
};

}  // namespace rotrocc
