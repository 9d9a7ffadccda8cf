#pragma once

#include <cstddef>
#include <vector>

#include "common/median.h"
#include "rotrocc/correspondence.h"

namespace rotrocc {

/// The median depth [m] of the features of a set that is not empty, in the current frame.
/// `depths_m` is a buffer.
inline double medianDepth(const Correspondences& features,
                          const FeatureSet& set,
                          std::vector<double>& depths_m) {
  depths_m.clear();
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (set[i] != 0) depths_m.push_back(features[i].point_cur.z());
  }
  return median(depths_m);
}

}  // namespace rotrocc
