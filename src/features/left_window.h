#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "kernels/kernels.h"

namespace rotrocc {

/// A match and the contrast of its window relative to that of the left one.
struct RowMatch {
  static constexpr float kNoColumn = -1.0F;

  float column = kNoColumn;
  double gain = 1.0;
};

/// Buffers of a search along a row, one for each thread.
struct RowBuffers {
  std::vector<std::int16_t> strip;
  std::vector<std::int32_t> scratch;
  std::vector<float> correlations;
  std::vector<int> peaks;     // columns
  std::vector<double> costs;  // of the peaks
};

/// The window around a left pixel. Its cost relative to another window is 1 minus their correlation
/// coefficient: zero-mean normalized cross-correlation, which no difference in brightness or
/// contrast changes. That is half the mean squared difference of both, each scaled to variance 1.
class LeftWindow {
 public:
  static constexpr int kHalf = CorrelationWindow::kSide / 2;

  /// At whole pixels.
  LeftWindow(const Kernels& kernels, const cv::Mat& left, const cv::Point& pixel);

  /// Between pixels.
  LeftWindow(const Kernels& kernels, const cv::Mat& left, const cv::Point2f& pixel);

  /// Searches the strip of a right row for the best of `count` windows.
  RowMatch searchRow(const std::int16_t* strip, int stride, int count, RowBuffers& buffers) const;

  /// As searchRow(), for a few windows and without a test for competitors.
  RowMatch searchNear(const std::int16_t* strip, int stride, int count) const;

 private:
  struct Compared {
    double cost;
    double variance;
  };

  void describe();
  double varianceOf(double count, double sum, double squares) const;
  Compared compare(const std::int16_t* strip, int stride) const;
  RowMatch refined(int column,
                   const Compared& before,
                   const Compared& at,
                   const Compared& after) const;

  const Kernels& kernels_;
  double unit2_;
  double sum_ = 0.0;
  double variance_ = 0.0;
  std::int16_t values_[CorrelationWindow::kSide * CorrelationWindow::kStride];
};

}  // namespace rotrocc
