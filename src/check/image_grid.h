#pragma once

#include <algorithm>
#include <cstddef>

#include <opencv2/core.hpp>

namespace rotrocc {

/// Cells of an image for maps: about square, kColumns of them side by side.
class ImageGrid {
 public:
  static constexpr int kColumns = 16;
  static constexpr std::size_t kLeast = 5;  ///< values of a cell that has one in a map

  ImageGrid(int width, int height, int columns = kColumns)
      : width_(width),
        height_(height),
        columns_(columns),
        rows_(std::max(1, cvRound(static_cast<double>(columns) * height / width))) {}

  std::size_t count() const { return static_cast<std::size_t>(columns_ * rows_); }
  int columns() const { return columns_; }
  int rows() const { return rows_; }

  /// The cell of a pixel; the nearest one outside of the image.
  std::size_t of(double x, double y) const {
    const int column = std::clamp(cvFloor((x + 0.5) * columns_ / width_), 0, columns_ - 1);
    const int row = std::clamp(cvFloor((y + 0.5) * rows_ / height_), 0, rows_ - 1);
    return static_cast<std::size_t>(row * columns_ + column);
  }

  cv::Point2d centre(std::size_t cell) const {
    const auto index = static_cast<int>(cell);
    return {(index % columns_ + 0.5) * width_ / columns_ - 0.5,
            (index / columns_ + 0.5) * height_ / rows_ - 0.5};
  }

 private:
  int width_;
  int height_;
  int columns_;
  int rows_;
};

}  // namespace rotrocc
