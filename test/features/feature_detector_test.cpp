#include "features/feature_detector.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace rotrocc {
namespace {

using Corners = std::vector<cv::Point2f>;

Corners detect(const cv::Mat& image,
               const FeatureDetector::Config& config = {},
               int candidates = 1) {
  Corners corners;
  FeatureDetector(config).detect(image, corners, candidates);
  return corners;
}

/// All corners in decreasing strength: a square image is a single cell.
Corners detectAll(const cv::Mat& image) {
  EXPECT_EQ(image.rows, image.cols);
  FeatureDetector::Config config;
  config.max_features = 1;
  return detect(image, config, 20000);
}

/// The larger of the distances in x and y.
float distance(const cv::Point2f& a, const cv::Point2f& b) {
  return std::max(std::abs(a.x - b.x), std::abs(a.y - b.y));
}

/// Blurred noise with the given standard deviation [gray levels]: corners everywhere, and hardly
/// any noise from pixel to pixel.
cv::Mat textureImage(const cv::Size& size, double contrast) {
  constexpr double kBlur_px = 2.0;
  cv::RNG generator(7);
  cv::Mat texture(size, CV_32FC1);
  generator.fill(texture, cv::RNG::NORMAL, 0.0, 1.0);
  cv::GaussianBlur(texture, texture, cv::Size(), kBlur_px);
  // Blurring divides the standard deviation by twice the blur times the root of pi.
  texture.convertTo(texture, CV_8UC1, 2.0 * kBlur_px * std::sqrt(CV_PI) * contrast, 128.0);
  return texture;
}

/// A plain image with independent noise in each pixel.
cv::Mat noiseImage(const cv::Size& size, double sigma) {
  cv::RNG generator(5);
  cv::Mat noise(size, CV_8UC1);
  generator.fill(noise, cv::RNG::NORMAL, 128.0, sigma);
  return noise;
}

/// By definition: responses that no neighbor exceeds, and none above or to the left equals, in
/// decreasing order.
Corners peaksOfTheResponse(const cv::Mat& image) {
  constexpr int kRowStep = CornerResponse::kRowStep;
  constexpr int kRadius = FeatureDetector::kMaxRadius_px;
  constexpr int kRows = kRadius / kRowStep;
  constexpr int kBorder = FeatureDetector::kBorder_px;
  cv::Mat response;
  CornerResponse().compute(image, 0, (image.rows + kRowStep - 1) / kRowStep, 0, response);
  cv::Mat before = cv::Mat::zeros(2 * kRows + 1, 2 * kRadius + 1, CV_8UC1);
  before.rowRange(0, kRows).setTo(1);
  before.row(kRows).colRange(0, kRadius).setTo(1);
  cv::Mat highest_before, highest;
  cv::dilate(response, highest_before, before);
  cv::dilate(response, highest, 1 - before);
  std::vector<cv::Point> peaks;
  cv::findNonZero((response > highest_before) & (response == highest), peaks);
  std::stable_sort(peaks.begin(), peaks.end(), [&](const cv::Point& a, const cv::Point& b) {
    return response.at<float>(a) > response.at<float>(b);
  });
  const cv::Rect inside(kBorder, kBorder, image.cols - 2 * kBorder, image.rows - 2 * kBorder);
  Corners corners;
  for (const cv::Point& peak : peaks) {
    const cv::Point pixel(peak.x, kRowStep * peak.y);
    if (inside.contains(pixel)) corners.emplace_back(pixel);
  }
  return corners;
}

float strength(const cv::Mat& image, const cv::Point2f& corner) {
  const int row = cvRound(corner.y) / CornerResponse::kRowStep;
  cv::Mat response;
  CornerResponse().compute(image, row, row + 1, 0, response);
  return response.at<float>(0, cvRound(corner.x));
}

TEST(FeatureDetectorTest, FindsThePeaksOfTheResponse) {
  for (const int side : {40, 128, 203}) {  // also with a part of a strip
    cv::Mat image = textureImage({side, side}, 40.0);
    for (int y = 50; y < std::min(80, side); ++y) {  // equal corners across a strip boundary
      for (int x = 0; x < side; ++x) image.at<uchar>(y, x) = (x / 3 + y / 3) % 2 == 0 ? 60 : 200;
    }
    const Corners corners = detectAll(image);
    Corners peaks = peaksOfTheResponse(image);
    // The weakest are left out.
    ASSERT_LE(corners.size(), peaks.size()) << side;
    EXPECT_FALSE(corners.empty()) << side;
    EXPECT_GT(corners.size(), peaks.size() * 9 / 10) << side;
    peaks.resize(corners.size());
    EXPECT_TRUE(std::is_permutation(corners.begin(), corners.end(), peaks.begin())) << side;
    // Strengths are told apart in steps of at most 1/32.
    for (std::size_t i = 0; i < corners.size(); ++i) {
      EXPECT_NEAR(strength(image, corners[i]) / strength(image, peaks[i]), 1.0, 1.0 / 32.0) << side;
    }
  }
}

TEST(FeatureDetectorTest, SmallImagesHaveDenserCorners) {
  const auto nearest_px = [](int side) {
    Corners corners;
    FeatureDetector({}).detect(textureImage({side, side}, 40.0), corners, 4);
    float nearest_px = 1e3F;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        nearest_px = std::min(nearest_px, distance(corners[i], corners[j]));
      }
    }
    return nearest_px;
  };
  EXPECT_GT(nearest_px(100), FeatureDetector::kMinRadius_px);
  EXPECT_LE(nearest_px(100), FeatureDetector::kMaxRadius_px);
  EXPECT_GT(nearest_px(400), FeatureDetector::kMaxRadius_px);
}

TEST(FeatureDetectorTest, FindsNearlyNothingInNoise) {
  // Measured: none. There is room for more than 2000.
  for (const double sigma : {1.0, 2.0, 4.0}) {
    EXPECT_LE(detect(noiseImage({640, 480}, sigma), {}, 4).size(), 5u) << sigma;
  }
}

TEST(FeatureDetectorTest, FindsTheSameAtATenthOfTheContrast) {
  const Corners full = detectAll(textureImage({300, 300}, 40.0));
  const Corners tenth = detectAll(textureImage({300, 300}, 4.0));
  ASSERT_GT(full.size(), 400u);
  EXPECT_NEAR(static_cast<double>(tenth.size()), static_cast<double>(full.size()), 20.0);
  const auto again = std::count_if(full.begin(), full.end(), [&](const cv::Point2f& a) {
    return std::any_of(
        tenth.begin(), tenth.end(), [&](const cv::Point2f& b) { return distance(a, b) <= 2.0F; });
  });
  EXPECT_GT(again, static_cast<std::ptrdiff_t>(full.size() * 9 / 10)) << again;
}

TEST(FeatureDetectorTest, HasAboutOneCellForEachFeatureInStrongAndWeakTexture) {
  cv::Mat image = textureImage({300, 200}, 50.0);
  textureImage({150, 200}, 8.0).copyTo(image(cv::Rect(150, 0, 150, 200)));
  for (const auto& [features, side_px] : {std::pair(24, 50), {96, 25}, {150, 20}}) {
    FeatureDetector::Config config;
    config.max_features = features;
    std::set<std::pair<int, int>> cells;
    const Corners corners = detect(image, config);
    ASSERT_EQ(static_cast<int>(corners.size()), features);
    for (const cv::Point2f& corner : corners) {
      cells.emplace(cvFloor(corner.x) / side_px, cvFloor(corner.y) / side_px);
    }
    // The border leaves some without a corner.
    EXPECT_GE(static_cast<int>(cells.size()), features * 9 / 10);
  }
}

TEST(FeatureDetectorTest, GivesNoMoreThanAskedFor) {
  FeatureDetector::Config config;
  config.max_features = 50;
  const cv::Mat image = textureImage({300, 200}, 40.0);
  const Corners first = detect(image, config);
  EXPECT_EQ(first.size(), 50u);
  Corners more = detect(image, config, 3);
  EXPECT_EQ(more.size(), 150u);
  more.resize(50);
  EXPECT_EQ(more, first) << "more candidates come after the first ones";
}

TEST(FeatureDetectorTest, FindsNothingWhereThereIsNothing) {
  EXPECT_TRUE(detect(cv::Mat(200, 300, CV_8UC1, cv::Scalar(90))).empty());
  // An edge is not a corner.
  cv::Mat edge = cv::Mat::zeros(200, 300, CV_8UC1);
  edge.colRange(150, 300).setTo(255);
  EXPECT_TRUE(detect(edge).empty());
  for (const cv::Size size : {cv::Size(), cv::Size(1, 1), cv::Size(500, 20), cv::Size(20, 500)}) {
    EXPECT_TRUE(detect(textureImage({500, 500}, 40.0)(cv::Rect({0, 0}, size))).empty()) << size;
  }
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
    const cv::Mat image = noiseImage(size, 150.0);  // the largest possible gradients
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
