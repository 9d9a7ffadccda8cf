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

/// Neighbouring features share an error of their disparities: what calibration and rectification
/// leave of the lenses, and texture that their windows have in common. The image is divided into
/// cells, and the features of a cell share one unknown error.
///
/// What the lenses leave is also smooth over the whole image. On KITTI most of it is a parabola
/// over the rows, see parabolaOverRows().
struct SharedErrorGrid : ImageGrid {
  static constexpr int kColumns = 12;
  static constexpr int kRows = 4;
  static constexpr std::size_t kCells = kColumns * kRows;

  explicit SharedErrorGrid(const StereoCamera& camera) : ImageGrid(camera, kColumns, kRows) {}
};

/// Standard deviation of a smooth error at the borders of the image, as a share of that of the
/// error of a cell.
constexpr double kSmoothShare = 0.6;

/// y^2 of a pixel, where y is -1 at the top and 1 at the bottom of the image.
inline double parabolaOverRows(const StereoCamera& camera, const Eigen::Vector2d& pixel) {
  const double y = 2.0 * pixel.y() / camera.height - 1.0;
  return y * y;
}

}  // namespace rotrocc
