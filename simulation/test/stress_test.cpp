// What makes the images of a sequence worse.

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "simulation/stress/image_stress.h"
#include "support/expect_error.h"

namespace rotrocc {
namespace {

/// Random, the same in each call, and textured everywhere.
cv::Mat texture() {
  cv::Mat image(200, 300, CV_8UC1);
  cv::RNG(1).fill(image, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(image, image, {}, 1.0);
  return image;
}

/// Mean size of the slopes: how much texture there is.
double textureOf(const cv::Mat& image) {
  cv::Mat slopes;
  cv::Sobel(image, slopes, CV_32F, 1, 0);
  return cv::norm(slopes, cv::NORM_L1) / static_cast<double>(image.total());
}

double shareOfDifference(const cv::Mat& a, const cv::Mat& b) {
  return cv::countNonZero(a != b) / static_cast<double>(a.total());
}

ImageStress stress(double ImageStress::*value, double level) {
  ImageStress stress;
  stress.*value = level;
  return stress;
}

TEST(ImageStress, ChangesGreyLevels) {
  const ImageStress step = stress(&ImageStress::gain_step, 4.0);
  ImageStress weaker = stress(&ImageStress::right_gain, 0.5);
  weaker.right_offset = -20.0;
  const struct {
    ImageStress stress;
    int pair;
    bool right;
    double level;
  } rows[] = {{{}, 3, true, 100.0},
              {step, 4, false, 50.0},
              {step, 5, false, 200.0},
              {step, 5, true, 200.0},
              {step, 10, false, 50.0},
              {weaker, 0, false, 100.0},
              {weaker, 9, true, 30.0},
              {stress(&ImageStress::contrast, 0.2), 0, false, 108.0}};
  const cv::Mat grey(10, 10, CV_8UC1, cv::Scalar(100));
  for (const auto& row : rows) {
    EXPECT_EQ(cv::mean(stressed(grey, row.stress, row.pair, row.right))[0], row.level);
  }
}

TEST(ImageStress, NoiseIsOfTheSeedAndAnotherInEachImage) {
  const ImageStress noise = stress(&ImageStress::noise_sigma, 5.0);
  const cv::Mat noisy = stressed(texture(), noise, 0, false);
  EXPECT_EQ(shareOfDifference(noisy, stressed(texture(), noise, 0, false)), 0.0);
  EXPECT_GT(shareOfDifference(noisy, stressed(texture(), noise, 0, true)), 0.8);
  EXPECT_GT(shareOfDifference(noisy, stressed(texture(), noise, 1, false)), 0.8);
}

TEST(ImageStress, TextureVanishesFromTheLeft) {
  const cv::Mat image = texture();
  const cv::Mat plain = stressed(image, stress(&ImageStress::plain_share, 0.5), 0, false);
  const cv::Range left(0, image.cols / 4), right(3 * image.cols / 4, image.cols);
  EXPECT_LT(textureOf(plain.colRange(left)), 0.25 * textureOf(image.colRange(left)));
  EXPECT_EQ(shareOfDifference(plain.colRange(right), image.colRange(right)), 0.0);
}

TEST(ImageStress, DropsStayOnTheirLens) {
  const cv::Mat image = texture();
  const ImageStress drops = stress(&ImageStress::drop_share, 0.3);
  const cv::Mat first = stressed(image, drops, 0, false) != image;
  EXPECT_NEAR(cv::countNonZero(first) / static_cast<double>(first.total()), 0.3, 0.1);
  EXPECT_EQ(shareOfDifference(first, stressed(image, drops, 7, false) != image), 0.0);
  EXPECT_GT(shareOfDifference(first, stressed(image, drops, 0, true) != image), 0.2);
}

TEST(ImageStress, RefusesLevelsOutOfRange) {
  expectError<std::invalid_argument>([] { stress(&ImageStress::contrast, 1.5).check(); },
                                     "contrast is 1.5");
}

}  // namespace
}  // namespace rotrocc
