#pragma once

#include <cstddef>

#include "geometry/image_grid.h"
#include "motion/fitted_feature.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Neighbouring features share an error of their disparities: what calibration and rectification
/// leave of the lenses, and texture that their windows have in common. The image is divided into
/// cells, and the features of a cell share one unknown error.
struct SharedErrorGrid {
  static constexpr int kColumns = 12;
  static constexpr int kRows = 4;
  static constexpr std::size_t kCells = kColumns * kRows;

  explicit SharedErrorGrid(const StereoCamera& camera) : grid(camera, kColumns, kRows) {}

  std::size_t cell(const FittedFeature& feature) const { return grid.cell(feature.target_px); }

  ImageGrid grid;
};

}  // namespace rotrocc
