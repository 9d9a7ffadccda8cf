#include "features/image_noise.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "common/median.h"

namespace rotrocc {

double noiseVariance(const cv::Mat& image) {
  constexpr double kRounding = 1.0 / 12.0;
  constexpr double kPixels = 1000.0;  // so the deviation is known to 4 %
  constexpr double kMaskSquares = 36.0;
  constexpr int kApart = 2;  // neighbors share noise if the image was interpolated to rectify it
  const int step = std::max(1, cvFloor(std::sqrt(static_cast<double>(image.total()) / kPixels)));
  thread_local std::vector<int> responses;
  responses.clear();
  for (int y = kApart; y + kApart < image.rows; y += step) {
    const auto* above = image.ptr<uchar>(y - kApart);
    const auto* here = image.ptr<uchar>(y);
    const auto* below = image.ptr<uchar>(y + kApart);
    for (int x = kApart; x + kApart < image.cols; x += step) {
      const int left = x - kApart;
      const int right = x + kApart;
      const int corners = above[left] + above[right] + below[left] + below[right];
      const int edges = above[x] + below[x] + here[left] + here[right];
      responses.push_back(std::abs(corners - 2 * edges + 4 * here[x]));
    }
  }
  if (responses.empty()) return kRounding;
  const double deviation = kDeviationOverMedian * median(responses);
  return std::max(kRounding, deviation * deviation / kMaskSquares);
}

bool isNoise(const cv::Mat& image) {
  constexpr double kOverNoise = 2.0;
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(image, mean, deviation);
  return deviation[0] * deviation[0] < kOverNoise * kOverNoise * noiseVariance(image);
}

}  // namespace rotrocc
