#pragma once

#include <cstddef>
#include <iosfwd>
#include <utility>
#include <vector>

#include "bags/recorded_pairs.h"

namespace rotrocc {

/// All pairs of a recording, read in advance, so that reading does not disturb the timing.
class PreloadedPairs {
 public:
  /// Throws like RecordedPairs::next().
  explicit PreloadedPairs(RecordedPairs& pairs);

  /// Returns false and leaves the arguments unchanged at the end.
  bool next(StereoPair& pair, StereoCamera& camera);

  /// Prints the peak memory of the process, split by use.
  void printMemory(std::ostream& out) const;

 private:
  std::vector<std::pair<StereoPair, StereoCamera>> pairs_;
  std::size_t next_ = 0;
  double images_MB_ = 0.0;
  double loaded_MB_ = 0.0;  // memory of the process after reading all images
};

}  // namespace rotrocc
