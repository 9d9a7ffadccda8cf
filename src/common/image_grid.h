#pragma once

#include <algorithm>
#include <cstddef>

#include <opencv2/core.hpp>

namespace rotrocc {

/// Divides an image into cells of equal size, numbered row by row.
class ImageGrid {
 public:
  ImageGrid(int width, int height, int columns, int rows)
      : cells_(columns, rows),
        columns_per_px_(static_cast<double>(columns) / width),
        rows_per_px_(static_cast<double>(rows) / height) {}

  std::size_t count() const { return static_cast<std::size_t>(cells_.area()); }

  /// Columns and rows.
  cv::Size size() const { return cells_; }

  /// The cell of a pixel; the nearest one outside of the image.
  std::size_t cell(double x, double y) const {
    const int column = std::clamp(static_cast<int>(x * columns_per_px_), 0, cells_.width - 1);
    const int row = std::clamp(static_cast<int>(y * rows_per_px_), 0, cells_.height - 1);
    return static_cast<std::size_t>(row * cells_.width + column);
  }

  cv::Point2d center(std::size_t cell) const {
    const auto index = static_cast<int>(cell);
    return {(index % cells_.width + 0.5) / columns_per_px_,
            (index / cells_.width + 0.5) / rows_per_px_};
  }

 private:
  cv::Size cells_;
  double columns_per_px_, rows_per_px_;
};

}  // namespace rotrocc
