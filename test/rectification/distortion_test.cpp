#include "rectification/distortion.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "support/expect_error.h"

namespace rotrocc {
namespace {

const std::vector<double> kPlumbBob = {-0.283, 0.074, 0.0012, -0.0007, 0.003};
const std::vector<double> kRational = {0.31, 0.12, 0.0009, -0.0011, 0.005, 0.65, 0.21, 0.03};
const std::vector<double> kEquidistant = {0.0035, 0.0007, -0.0021, 0.0002};

/// Points up to 45 degrees from the axis.
std::vector<cv::Point3d> points() {
  std::vector<cv::Point3d> points;
  for (double y = -0.7; y <= 0.7; y += 0.2) {
    for (double x = -0.7; x <= 0.7; x += 0.2) points.emplace_back(x, y, 1.0);
  }
  return points;
}

void expectSame(const Distortion& distortion, const std::vector<cv::Point2d>& expected) {
  for (std::size_t i = 0; i < points().size(); ++i) {
    const Eigen::Vector2d point(points()[i].x, points()[i].y);
    const Eigen::Vector2d seen = distortion.distort(point);
    EXPECT_NEAR(seen.x(), expected[i].x, 1e-12);
    EXPECT_NEAR(seen.y(), expected[i].y, 1e-12);
    // 1e-9 of a focal length is a millionth of a pixel.
    EXPECT_LT((distortion.undistort(seen) - point).norm(), 1e-9);
  }
}

TEST(DistortionTest, IsThatOfOpenCv) {
  const cv::Mat none = cv::Mat::zeros(3, 1, CV_64F);
  const cv::Mat K = cv::Mat::eye(3, 3, CV_64F);
  std::vector<cv::Point2d> seen;
  cv::projectPoints(points(), none, none, K, kPlumbBob, seen);
  expectSame({"plumb_bob", kPlumbBob}, seen);
  expectSame({"radial-tangential", kPlumbBob}, seen);
  cv::projectPoints(points(), none, none, K, kRational, seen);
  expectSame({"rational_polynomial", kRational}, seen);
  cv::fisheye::projectPoints(points(), seen, none, none, K, kEquidistant);
  expectSame({"equidistant", kEquidistant}, seen);
  expectSame({"fisheye", kEquidistant}, seen);
}

TEST(DistortionTest, WithoutCoefficientsThereIsNone) {
  EXPECT_TRUE(Distortion().isNone());
  EXPECT_TRUE(Distortion("plumb_bob", {}).isNone());
  EXPECT_TRUE(Distortion("plumb_bob", {0, 0, 0, 0, 0}).isNone());
  EXPECT_FALSE(Distortion("plumb_bob", {0, 0, 0.01, 0}).isNone());
  EXPECT_FALSE(Distortion("equidistant", {}).isNone()) << "it is not a pinhole camera";
  EXPECT_EQ(Distortion().distort({0.5, 2.0}), Eigen::Vector2d(0.5, 2.0));
}

TEST(DistortionTest, DoesNotFoldBack) {
  const Distortion barrel("plumb_bob", {-0.4, 0, 0, 0});
  const double limit = 1.0 / std::sqrt(3.0 * 0.4);  // where r - 0.4 r^3 is largest
  EXPECT_NEAR(barrel.limit(), limit, 0.02) << "to a quarter of a degree";
  const double widest = barrel.distort({barrel.limit(), 0.0}).x();
  EXPECT_NEAR(barrel.distort({3.0, 0.0}).x(), widest, 1e-6);
  EXPECT_NEAR(barrel.undistort({2.0, 0.0}).x(), barrel.limit(), 1e-6);
  EXPECT_GT(Distortion("equidistant", kEquidistant).limit(), std::tan(80.0 * M_PI / 180.0));
}

TEST(DistortionTest, RefusesWhatIsNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const struct {
    const char* model;
    std::vector<double> coefficients;
    const char* part;
  } kCases[] = {{"omni", {1, 2, 3, 4}, "'omni' is not supported: use plumb_bob"},
                {"plumb_bob", {1, 2, 3}, "3 coefficients instead of 5"},
                {"equidistant", {1, 2, 3, 4, 5}, "5 coefficients instead of 4"},
                {"plumb_bob", {0, nan, 0, 0}, "nan"},
                {"plumb_bob", {-1e6, 0, 0, 0}, "in the middle of the image"}};
  for (const auto& [model, coefficients, part] : kCases) {
    const std::string name = model;
    const std::vector<double>& values = coefficients;
    expectError<std::invalid_argument>([&] { Distortion(name, values); }, part);
  }
}

}  // namespace
}  // namespace rotrocc
