#include "features/corner_response.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace rotrocc {
namespace {

/// Unfiltered noise, with the largest possible gradients.
cv::Mat noiseImage(const cv::Size& size) {
  cv::RNG generator(3);
  cv::Mat noise(size, CV_8UC1);
  generator.fill(noise, cv::RNG::NORMAL, 128.0, 150.0);
  return noise;
}

TEST(CornerResponseTest, IsTheSmallerEigenvalue) {
  constexpr int kRowStep = CornerResponse::kRowStep;
  constexpr int kRadius = CornerResponse::kRadius_px;
  constexpr int kSide = 2 * kRadius + 1;
  constexpr double kFullScale = 255.0;
  CornerResponse corner_response;
  // Widths that are a whole number of registers and others, and sizes too small for a response.
  for (const cv::Size size :
       {cv::Size(64, 40), cv::Size(71, 45), cv::Size(33, 35), cv::Size(7, 5), cv::Size(2, 40)}) {
    const cv::Mat image = noiseImage(size);
    const int rows = (size.height + 1) / kRowStep;
    cv::Mat response, expected;
    corner_response.compute(image, 0, rows, 0, response);
    cv::cornerMinEigenVal(image, expected, kSide, 3, cv::BORDER_REPLICATE);
    // OpenCV divides the sums of the Sobel masks by 4 and the full scale, CornerResponse by 8.
    expected *= 0.25 * kFullScale * kFullScale;
    const cv::Rect inside(kRadius, kRadius, size.width - 2 * kRadius, size.height - 2 * kRadius);
    for (int row = 0; row < rows; ++row) {
      for (int x = 0; x < size.width; ++x) {
        const cv::Point pixel(x, kRowStep * row);
        // Single-precision error of eigenvalues up to 2e4.
        ASSERT_NEAR(response.at<float>(row, x),
                    inside.contains(pixel) ? expected.at<float>(pixel) : 0.0F,
                    0.05)
            << size << " at " << pixel;
      }
    }
  }
}

}  // namespace
}  // namespace rotrocc
