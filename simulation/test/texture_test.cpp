#include "simulation/surfaces/texture.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace rotrocc {
namespace {

constexpr double kPeriod_m = 4.0;
constexpr int kSize = 64;
constexpr double kTexel_m = kPeriod_m / kSize;
constexpr double kGreyLevel = 1.0 / 255.0;  // texels are kept as such

/// Dark but for every fourth column, whose values rise along x.
cv::Mat stripes() {
  cv::Mat tile(kSize, kSize, CV_32FC1, cv::Scalar(0.0));
  for (int x = 0; x < kSize; x += 4) tile.col(x).setTo(static_cast<float>(x) / kSize);
  return tile;
}

/// The point in the middle of a texel, with a pixel of this size on the surface.
TexturePoint texel(int column, int row, double width_m, double height_m) {
  return {{(column + 0.5) * kTexel_m, (row + 0.5) * kTexel_m}, {width_m, 0.0}, {0.0, height_m}};
}

TEST(TextureTest, SmallPixelsSeeTheTexels) {
  const Texture texture(stripes(), kPeriod_m);
  for (const int x : {0, 1, 4, 40, 60, 63}) {
    EXPECT_NEAR(texture.at(texel(x, 7, 1e-4, 1e-4)), stripes().at<float>(7, x), kGreyLevel) << x;
  }
}

TEST(TextureTest, IsRepeatedInBothDirections) {
  const Texture texture(stripes(), kPeriod_m);
  for (const int periods : {-3, 0, 1, 250}) {
    const TexturePoint at = texel(40 + periods * kSize, 9 - periods * kSize, 1e-4, 1e-4);
    EXPECT_NEAR(texture.at(at), 40.0 / kSize, kGreyLevel) << periods;
  }
}

TEST(TextureTest, PixelsAsLargeAsTheTileSeeItsMean) {
  const Texture texture(stripes(), kPeriod_m);
  const double mean = cv::mean(stripes())[0];
  for (const double size_m : {kPeriod_m, 100.0, 1e6, 1e12}) {
    EXPECT_NEAR(texture.at(texel(3, 5, size_m, size_m)), mean, 2.0 * kGreyLevel) << size_m;
  }
}

TEST(TextureTest, LongPixelsAreBlurredAlongTheirLengthOnly) {
  const Texture texture(stripes(), kPeriod_m);
  const double along = texture.at(texel(40, 7, 1e-4, 3.0 * kTexel_m));
  const double across = texture.at(texel(40, 7, 3.0 * kTexel_m, 1e-4));
  EXPECT_GT(along, 0.8 * 40.0 / kSize);           // a little of the next coarser level is mixed in
  EXPECT_NEAR(across, 40.0 / kSize / 3.0, 0.05);  // a light column and two dark ones
}

TEST(TextureTest, RefusesTilesThatCannotBeHalved) {
  expectError<std::invalid_argument>(
      [] { Texture texture(cv::Mat(48, 48, CV_32FC1, cv::Scalar(0.5)), 1.0); }, "48 x 48");
  expectError<std::invalid_argument>(
      [] { Texture texture(cv::Mat(64, 64, CV_8UC1, cv::Scalar(5)), 1.0); }, "CV_32FC1");
}

}  // namespace
}  // namespace rotrocc
