#pragma once

#include <algorithm>
#include <cstddef>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace rotrocc {

/// Cells of an image for maps: about square, kColumns of them side by side.
class ImageGrid {
 public:
  static constexpr int kColumns = 16;
  static constexpr std::size_t kLeast = 5;  ///< values of a cell that has one in a map

  ImageGrid(int width, int height, int columns = kColumns)
      : width_(width),
        height_(height),
        cells_(columns, std::max(1, cvRound(static_cast<double>(columns) * height / width))) {}

  std::size_t count() const { return static_cast<std::size_t>(cells_.area()); }

  /// Columns and rows.
  cv::Size size() const { return cells_; }

  /// The cell of a pixel; the nearest one outside of the image.
  std::size_t of(double x, double y) const {
    const int column = std::clamp(cvFloor((x + 0.5) * cells_.width / width_), 0, cells_.width - 1);
    const int row = std::clamp(cvFloor((y + 0.5) * cells_.height / height_), 0, cells_.height - 1);
    return static_cast<std::size_t>(row * cells_.width + column);
  }

  cv::Point2d center(std::size_t cell) const {
    const auto index = static_cast<int>(cell);
    return {(index % cells_.width + 0.5) * width_ / cells_.width - 0.5,
            (index / cells_.width + 0.5) * height_ / cells_.height - 0.5};
  }

 private:
  int width_;
  int height_;
  cv::Size cells_;
};

/// The mean of each cell of an image, CV_8UC1.
inline cv::Mat cellMeans(const cv::Mat& image, const ImageGrid& grid) {
  cv::Mat sums, means(grid.size(), CV_32FC1);
  cv::integral(image, sums, CV_32S);
  const auto edge = [](int index, int cells, int pixels) { return index * pixels / cells; };
  for (int row = 0; row < means.rows; ++row) {
    const int top = edge(row, means.rows, image.rows);
    const int bottom = std::max(edge(row + 1, means.rows, image.rows), top + 1);
    for (int column = 0; column < means.cols; ++column) {
      const int left = edge(column, means.cols, image.cols);
      const int right = std::max(edge(column + 1, means.cols, image.cols), left + 1);
      const int sum = sums.at<int>(bottom, right) - sums.at<int>(top, right) -
                      sums.at<int>(bottom, left) + sums.at<int>(top, left);
      means.at<float>(row, column) =
          static_cast<float>(sum) / static_cast<float>((bottom - top) * (right - left));
    }
  }
  return means;
}

}  // namespace rotrocc
