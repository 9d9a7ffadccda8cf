#pragma once

#include <algorithm>
#include <cstddef>

#include <Eigen/Core>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Divides an image into cells of equal size, numbered row by row.
class ImageGrid {
 public:
  ImageGrid(const StereoCamera& camera, int columns, int rows)
      : columns_(columns),
        rows_(rows),
        columns_per_px_(static_cast<double>(columns) / camera.width),
        rows_per_px_(static_cast<double>(rows) / camera.height) {}

  /// The cell of a pixel. Pixels outside the image belong to the nearest cell.
  std::size_t cell(const Eigen::Vector2d& pixel) const {
    const int column = std::clamp(static_cast<int>(pixel.x() * columns_per_px_), 0, columns_ - 1);
    const int row = std::clamp(static_cast<int>(pixel.y() * rows_per_px_), 0, rows_ - 1);
    return static_cast<std::size_t>(row * columns_ + column);
  }

 private:
  int columns_;
  int rows_;
  double columns_per_px_;
  double rows_per_px_;
};

}  // namespace rotrocc
