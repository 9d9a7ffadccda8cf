#include "features/feature_detector.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace rotrocc {
namespace {

using Corners = std::vector<cv::Point2f>;

Corners detect(const cv::Mat& image, const FeatureDetector::Config& config = {}, int threads = 1) {
  Corners corners;
  Workers workers(threads);
  FeatureDetector(config).detect(workers, image, corners);
  return corners;
}

/// The larger of the distances in x and y.
float distance(const cv::Point2f& a, const cv::Point2f& b) {
  return std::max(std::abs(a.x - b.x), std::abs(a.y - b.y));
}

/// Blurred noise of the given contrast, with corners everywhere.
cv::Mat noiseImage(const cv::Size& size, double contrast) {
  cv::RNG generator(7);
  cv::Mat noise(size, CV_8UC1);
  generator.fill(noise, cv::RNG::NORMAL, 128.0, contrast);
  cv::GaussianBlur(noise, noise, cv::Size(), 1.0);
  return noise;
}

/// A white square on black whose edges cover half a pixel: corners at integer pixels, without
/// aliasing.
cv::Mat squareImage(const cv::Rect& square) {
  cv::Mat image = cv::Mat::zeros(160, 200, CV_8UC1);
  const cv::Point last = square.br() - cv::Point(1, 1);
  image(square).setTo(128);
  image(cv::Rect(square.tl() + cv::Point(1, 1), last)).setTo(255);
  for (const int x : {square.x, last.x}) {
    for (const int y : {square.y, last.y}) image.at<uchar>(y, x) = 64;
  }
  return image;
}

TEST(FeatureDetectorTest, FindsTheCornersOfASquareAndNothingElse) {
  const cv::Rect square(60, 40, 51, 61);
  Corners corners = detect(squareImage(square));
  ASSERT_EQ(corners.size(), 4u);
  for (const cv::Point2f expected :
       {cv::Point2f(60, 40), cv::Point2f(110, 40), cv::Point2f(60, 100), cv::Point2f(110, 100)}) {
    // A block contains both edges completely if its centre is inside the corner by up to its
    // radius.
    const auto found = std::find_if(corners.begin(), corners.end(), [&](const cv::Point2f& corner) {
      return distance(corner, expected) <= 2.0F && square.contains(corner);
    });
    EXPECT_NE(found, corners.end()) << expected;
  }
}

TEST(FeatureDetectorTest, KeepsCornersApart) {
  FeatureDetector::Config config;
  config.nms_radius_px = 6;
  // Corners everywhere, and a regular pattern whose corners are all equally strong.
  cv::Mat image = noiseImage({300, 200}, 60.0);
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 300; ++x) image.at<uchar>(y, x) = (x / 3 + y / 3) % 2 == 0 ? 60 : 200;
  }
  const Corners corners = detect(image, config);
  ASSERT_GT(corners.size(), 50u);
  float nearest = 1e9F;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      nearest = std::min(nearest, distance(corners[i], corners[k]));
    }
  }
  EXPECT_GT(nearest, 6.0F);
}

/// By definition: responses that no neighbour exceeds, and none above or to the left equals, in
/// decreasing order.
Corners expectedCorners(const cv::Mat& image, const FeatureDetector::Config& config) {
  cv::Mat response;
  constexpr int kRowStep = CornerResponse::kRowStep;
  const int rows = (image.rows + kRowStep - 1) / kRowStep;
  CornerResponse(config.block_radius_px).compute(image, 0, rows, 0, response);
  const int radius = config.nms_radius_px;
  const int row_radius = radius / kRowStep;
  const auto isCorner = [&](int x, int row) {
    const float value = response.at<float>(row, x);
    for (int r = std::max(row - row_radius, 0); r <= std::min(row + row_radius, rows - 1); ++r) {
      for (int u = std::max(x - radius, 0); u <= std::min(x + radius, image.cols - 1); ++u) {
        const float other = response.at<float>(r, u);
        const bool earlier = r < row || (r == row && u < x);
        if (other > value || (earlier && other == value)) return false;
      }
    }
    return value >= static_cast<float>(config.min_response);
  };
  Corners corners;
  for (int row = 0; row < rows; ++row) {
    const int y = kRowStep * row;
    if (y < config.border_px || y >= image.rows - config.border_px) continue;
    for (int x = config.border_px; x < image.cols - config.border_px; ++x) {
      if (isCorner(x, row)) corners.emplace_back(x, y);
    }
  }
  const auto responseAt = [&](const cv::Point2f& corner) {
    return response.at<float>(static_cast<int>(corner.y) / kRowStep, static_cast<int>(corner.x));
  };
  std::stable_sort(corners.begin(), corners.end(), [&](const auto& a, const auto& b) {
    return responseAt(a) > responseAt(b);
  });
  return corners;
}

TEST(FeatureDetectorTest, FindsThePeaksOfTheResponse) {
  cv::Mat image = noiseImage({203, 170}, 60.0);
  for (int y = 50; y < 80; ++y) {  // equally strong corners across a strip boundary
    for (int x = 0; x < 203; ++x) image.at<uchar>(y, x) = (x / 3 + y / 3) % 2 == 0 ? 60 : 200;
  }
  FeatureDetector::Config config;
  config.cell_size_px = 1000;
  config.max_features = 20000;
  for (const int radius_px : {1, 4, 7, 30}) {
    for (const int border_px : {1, 8}) {
      for (const double min_response : {0.0, 2.0, 300.0}) {
        config.nms_radius_px = radius_px;
        config.border_px = border_px;
        config.min_response = min_response;
        EXPECT_EQ(detect(image, config), expectedCorners(image, config))
            << radius_px << ", " << border_px << ", " << min_response;
      }
    }
  }
}

TEST(FeatureDetectorTest, SpreadsCornersOverStrongAndWeakTexture) {
  cv::Mat image = noiseImage({320, 192}, 80.0);
  const cv::Rect weak_half(160, 0, 160, 192);
  noiseImage({160, 192}, 12.0).copyTo(image(weak_half));
  FeatureDetector::Config config;
  config.max_features = 120;  // two for each of the 60 cells
  const Corners corners = detect(image, config);
  ASSERT_EQ(corners.size(), 120u);
  const auto weak = std::count_if(
      corners.begin(), corners.end(), [](const cv::Point2f& corner) { return corner.x >= 160; });
  // Cells at the border are smaller and may have fewer than two.
  EXPECT_NEAR(static_cast<double>(weak), 60.0, 12.0);
}

TEST(FeatureDetectorTest, TakesTheStrongestFirst) {
  cv::Mat image = cv::Mat::zeros(64, 64, CV_8UC1);
  image(cv::Rect(12, 12, 6, 6)).setTo(60);
  image(cv::Rect(40, 40, 6, 6)).setTo(250);
  FeatureDetector::Config config;
  config.max_features = 1;
  for (const int cell_size_px : {32, 1000}) {  // in separate cells, and in the same cell
    config.cell_size_px = cell_size_px;
    const Corners corners = detect(image, config);
    ASSERT_EQ(corners.size(), 1u);
    EXPECT_GT(corners[0].x, 32.0F) << cell_size_px;
  }
}

TEST(FeatureDetectorTest, LeavesTheBorderFree) {
  FeatureDetector::Config config;
  config.border_px = 20;
  const cv::Mat image = noiseImage({200, 100}, 60.0);
  const Corners corners = detect(image, config);
  ASSERT_FALSE(corners.empty());
  const cv::Rect2f inner(20, 20, 160, 60);
  for (const cv::Point2f& corner : corners) EXPECT_TRUE(inner.contains(corner)) << corner;
  config.border_px = 4;
  EXPECT_GT(detect(image, config).size(), corners.size());
}

TEST(FeatureDetectorTest, GivesNoMoreThanAskedFor) {
  FeatureDetector::Config config;
  config.max_features = 50;
  EXPECT_EQ(detect(noiseImage({300, 200}, 60.0), config).size(), 50u);
}

TEST(FeatureDetectorTest, FindsTheSameWhereverTheImageIsCutIntoStrips) {
  // The same texture 30 rows lower is divided differently into strips.
  const cv::Mat image = noiseImage({120, 230}, 60.0);
  FeatureDetector::Config config;
  config.cell_size_px = 1000;
  const Corners whole = detect(image, config);
  const Corners lower = detect(image.rowRange(30, 230), config);
  int compared = 0;
  for (const cv::Point2f& corner : whole) {
    if (corner.y < 50 || corner.y > 210) continue;
    ++compared;
    EXPECT_NE(std::find(lower.begin(), lower.end(), corner - cv::Point2f(0, 30)), lower.end())
        << corner;
  }
  EXPECT_GT(compared, 50);
}

TEST(FeatureDetectorTest, FindsNothingWhereThereIsNothing) {
  EXPECT_TRUE(detect(cv::Mat(200, 300, CV_8UC1, cv::Scalar(90))).empty());
  FeatureDetector::Config config;
  config.min_response = 0.0;
  EXPECT_TRUE(detect(cv::Mat(200, 300, CV_8UC1, cv::Scalar(90)), config).empty());
  // An edge is not a corner.
  cv::Mat edge = cv::Mat::zeros(200, 300, CV_8UC1);
  edge.colRange(150, 300).setTo(255);
  EXPECT_TRUE(detect(edge).empty());
}

TEST(FeatureDetectorTest, FindsNothingInTinyImages) {
  for (const cv::Size size : {cv::Size(), cv::Size(1, 1), cv::Size(500, 20), cv::Size(20, 500)}) {
    EXPECT_TRUE(detect(noiseImage({500, 500}, 60.0)(cv::Rect({0, 0}, size))).empty()) << size;
  }
}

TEST(FeatureDetectorTest, FindsTheSameWithAnyNumberOfThreads) {
  const cv::Mat image = noiseImage({400, 300}, 60.0);
  const Corners one = detect(image, {}, 1);
  const Corners two = detect(image, {}, 2);
  EXPECT_EQ(one, two);
  EXPECT_GT(one.size(), 500u);
}

}  // namespace
}  // namespace rotrocc
