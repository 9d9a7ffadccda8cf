#include "rectification/distortion.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace rotrocc {
namespace {

using Points = Distortion::Points;

TEST(DistortionTest, EachNameIsOfItsModel) {
  const struct {
    const char* model;
    std::vector<double> coefficients;
    double seen;  // of a point at 1, 45 degrees from the axis
  } kCases[] = {{"plumb_bob", {-0.25, 0.0625, 0, 0, 0.125}, 0.9375},
                {"radial-tangential", {-0.25, 0.0625, 0, 0.25}, 1.5625},  // 3 p2
                {"rational_polynomial", {1, 1, 0, 0, 1, 0.25, 0.25, 0.5}, 2.0},
                {"fisheye", {}, M_PI / 4.0},
                {"equidistant", {0.1, 0, 0, 0}, M_PI / 4.0 * (1.0 + 0.1 * M_PI * M_PI / 16.0)}};
  for (const auto& row : kCases) {
    const Distortion distortion(row.model, row.coefficients);
    EXPECT_NEAR(distortion.distort({{1.0, 0.0}})[0].x, row.seen, 1e-12) << row.model;
  }
}

TEST(DistortionTest, CanBeTakenBack) {
  for (const Distortion& distortion :
       {Distortion("plumb_bob", {-0.283, 0.074, 0.0012, -0.0007, 0.003}),
        Distortion("rational_polynomial", {0.31, 0.12, 0.0009, -0.0011, 0.005, 0.65, 0.21, 0.03}),
        Distortion("equidistant", {0.0035, 0.0007, -0.0021, 0.0002})}) {
    Points points;  // up to 45 degrees from the axis
    for (double y = -0.7; y <= 0.7; y += 0.2) {
      for (double x = -0.7; x <= 0.7; x += 0.2) points.emplace_back(x, y);
    }
    const Points again = distortion.undistort(distortion.distort(points));
    for (std::size_t i = 0; i < points.size(); ++i) {
      // 1e-9 of a focal length is a millionth of a pixel.
      EXPECT_LT(cv::norm(again[i] - points[i]), 1e-9) << distortion.name() << points[i];
    }
  }
}

TEST(DistortionTest, WithoutCoefficientsThereIsNone) {
  EXPECT_TRUE(Distortion().isNone());
  EXPECT_TRUE(Distortion("plumb_bob", {}).isNone());
  EXPECT_FALSE(Distortion("plumb_bob", {0, 0, 0.01, 0}).isNone());
  EXPECT_FALSE(Distortion("equidistant", {}).isNone()) << "it is not a pinhole camera";
  EXPECT_EQ(Distortion().distort({{0.5, 2.0}})[0], cv::Point2d(0.5, 2.0));
}

TEST(DistortionTest, DoesNotFoldBack) {
  const Distortion barrel("plumb_bob", {-0.4, 0, 0, 0});
  const double limit = 1.0 / std::sqrt(3.0 * 0.4);  // where r - 0.4 r^3 is largest
  EXPECT_NEAR(barrel.limit(), limit, 0.02) << "to a quarter of a degree";
  const Points seen = barrel.distort({{barrel.limit(), 0.0}, {3.0, 0.0}});
  EXPECT_NEAR(seen[1].x, seen[0].x, 1e-6);
  EXPECT_GT(Distortion("equidistant", {}).limit(), std::tan(80.0 * M_PI / 180.0));
}

TEST(DistortionTest, MoreCoefficientsThatAreZeroDoNotMatter) {
  const Points points = {{0.3, -0.2}, {0.0, 0.5}};
  EXPECT_EQ(Distortion("plumb_bob", {-0.3, 0.1, 0, 0, 0, 0, 0, 0}).distort(points),
            Distortion("plumb_bob", {-0.3, 0.1, 0, 0, 0}).distort(points));
  EXPECT_EQ(Distortion("equidistant", {0.1, 0, 0, 0, 0}).coefficients().size(), 4u);
  EXPECT_TRUE(Distortion("none", {0, 0, 0, 0, 0}).isNone());
  EXPECT_TRUE(Distortion("", {}).isNone());
}

TEST(DistortionTest, RejectsWhatIsNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const struct {
    const char* model;
    std::vector<double> coefficients;
    const char* part;
  } kCases[] = {{"omni", {1, 2, 3, 4}, "'omni' is not supported: use plumb_bob"},
                {"plumb_bob", {1, 2, 3}, "3 coefficients instead of 5"},
                {"none", {0.1}, "1 coefficients instead of 0"},
                {"equidistant", {1, 2, 3, 4, 5}, "5 coefficients instead of 4"},
                {"plumb_bob", {0, nan, 0, 0}, "nan"},
                {"plumb_bob", {-1e6, 0, 0, 0}, "in the middle of the image"}};
  for (const auto& row : kCases) {
    expectError<std::invalid_argument>([&] { Distortion(row.model, row.coefficients); }, row.part);
  }
}

}  // namespace
}  // namespace rotrocc
