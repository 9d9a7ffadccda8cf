#include "features/keyframe.h"

#include <algorithm>

namespace rotrocc {

void thinOut(const Keyframe& keyframe, std::size_t most_points, Keyframe& few) {
  few.row_offset_px = keyframe.row_offset_px;
  few.left_px.clear();
  few.right_px.clear();
  few.points.clear();
  const std::size_t points = keyframe.points.size();
  const std::size_t chosen = std::min(points, most_points);
  for (std::size_t n = 0; n < chosen; ++n) {
    const std::size_t i = n * points / chosen;
    few.left_px.push_back(keyframe.left_px[i]);
    few.right_px.push_back(keyframe.right_px[i]);
    few.points.push_back(keyframe.points[i]);
  }
}

}  // namespace rotrocc
