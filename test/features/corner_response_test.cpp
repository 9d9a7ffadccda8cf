#include "features/corner_response.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

/// Unfiltered noise, with the largest possible gradients.
cv::Mat noiseImage(const cv::Size& size) {
  cv::RNG generator(3);
  cv::Mat noise(size, CV_8UC1);
  generator.fill(noise, cv::RNG::NORMAL, 128.0, 150.0);
  return noise;
}

/// Sobel gradient; pixels outside the image repeat its border.
cv::Point gradient(const cv::Mat& image, int x, int y) {
  const auto pixel = [&](int u, int v) -> int {
    return image.at<uchar>(std::clamp(v, 0, image.rows - 1), std::clamp(u, 0, image.cols - 1));
  };
  cv::Point sum;
  for (const int k : {-1, 0, 0, 1}) {
    sum.x += pixel(x + 1, y + k) - pixel(x - 1, y + k);
    sum.y += pixel(x + k, y + 1) - pixel(x + k, y - 1);
  }
  return sum;
}

constexpr int kRowStep = CornerResponse::kRowStep;

/// The definition of the response, in double precision.
double expectedResponse(const cv::Mat& image, int x, int y) {
  constexpr int radius = CornerResponse::kRadius_px;
  if (std::min({x, y, image.cols - 1 - x, image.rows - 1 - y}) < radius) return 0.0;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (int v = y - radius; v <= y + radius; ++v) {
    for (int u = x - radius; u <= x + radius; ++u) {
      const cv::Point g = gradient(image, u, v);
      xx += g.x * g.x;
      xy += g.x * g.y;
      yy += g.y * g.y;
    }
  }
  const double smaller = 0.5 * (xx + yy - std::hypot(xx - yy, 2.0 * xy));
  const double side = 2.0 * radius + 1.0;
  return smaller / (64.0 * side * side);
}

TEST(CornerResponseTest, IsTheSmallerEigenvalue) {
  cv::Mat response;
  CornerResponse corner_response;
  // Widths that are a whole number of registers and others, and sizes too small for a response.
  for (const cv::Size size :
       {cv::Size(64, 40), cv::Size(71, 45), cv::Size(33, 35), cv::Size(7, 5), cv::Size(2, 40)}) {
    const cv::Mat image = noiseImage(size);
    const int rows = (size.height + 1) / kRowStep;
    corner_response.compute(image, 0, rows, 0, response);
    for (int row = 0; row < rows; ++row) {
      for (int x = 0; x < size.width; ++x) {
        const int y = kRowStep * row;
        // Single-precision error of eigenvalues up to 2e4.
        ASSERT_NEAR(response.at<float>(row, x), expectedResponse(image, x, y), 0.01)
            << size << " at " << x << ", " << y;
      }
    }
  }
}

}  // namespace
}  // namespace rotrocc
