#pragma once

#include <cstddef>

#include <opencv2/imgproc.hpp>

#include "common/image_grid.h"

namespace rotrocc {

constexpr int kMapColumns = 16;
/// Values that a cell of a map needs.
constexpr std::size_t kLeastInCell = 5;

/// About square cells, so many side by side.
inline ImageGrid mapOf(int width, int height, int columns = kMapColumns) {
  const int rows = cvRound(static_cast<double>(columns) * height / width);
  return {width, height, columns, std::max(1, rows)};
}

/// The mean of each cell of an image, CV_8UC1.
inline cv::Mat cellMeans(const cv::Mat& image, const ImageGrid& grid) {
  cv::Mat grays, means;
  image.convertTo(grays, CV_32F);
  cv::resize(grays, means, grid.size(), 0.0, 0.0, cv::INTER_AREA);
  return means;
}

/// What an image shows in each cell, as mean differences to its blurred self.
inline cv::Mat detailOf(const cv::Mat& image, const ImageGrid& grid) {
  cv::Mat coarse, fine;
  cv::blur(image, coarse, {9, 9});
  cv::absdiff(image, coarse, fine);
  return cellMeans(fine, grid);
}

/// A map of cells, CV_8UC1, without connected parts of fewer than `least`.
inline cv::Mat withoutSmallParts(cv::Mat cells, int least) {
  cv::Mat labels, statistics, centroids;
  const int parts = cv::connectedComponentsWithStats(cells, labels, statistics, centroids, 4);
  for (int part = 1; part < parts; ++part) {
    if (statistics.at<int>(part, cv::CC_STAT_AREA) < least) cells.setTo(0, labels == part);
  }
  return cells;
}

}  // namespace rotrocc
