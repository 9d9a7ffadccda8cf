// Stresses: what makes the images of a sequence worse, lorries and repeated texture.

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "simulation/drives/scenario.h"
#include "simulation/simulator.h"
#include "simulation/stress/image_stress.h"
#include "support/expect_error.h"
#include "support/small_camera.h"

namespace rotrocc {
namespace {

constexpr int kPair = 50;

SimulationOptions cleanOptions() {
  SimulationOptions options;
  options.camera = smallCamera();
  options.frames = kPair + 2;
  options.moving_share = 0.0;
  options.faults.sensor.noise_sigma = 0.0;
  options.faults.sensor.vignetting = 0.0;
  return options;
}

/// A rendered image.
const cv::Mat& street() {
  static const cv::Mat image =
      Simulator(scenario("city", 1), cleanOptions()).render(kPair, false).pair.left;
  return image;
}

double contrastOf(const cv::Mat& image) {
  cv::Scalar mean, deviation;
  cv::meanStdDev(image, mean, deviation);
  return deviation[0];
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

TEST(ImageStress, WithoutAnyTheImageIsTheSame) {
  EXPECT_EQ(shareOfDifference(stressed(street(), {}, 3, false), street()), 0.0);
}

TEST(ImageStress, NoiseHasItsSizeAndIsOfTheSeed) {
  ImageStress stress;
  stress.noise_sigma = 5.0;
  const cv::Mat grey(100, 200, CV_8UC1, cv::Scalar(100));
  const cv::Mat noisy = stressed(grey, stress, 0, false);
  EXPECT_NEAR(contrastOf(noisy), 5.0, 0.1);  // of 20 000 pixels: 4 sigma
  EXPECT_EQ(shareOfDifference(noisy, stressed(grey, stress, 0, false)), 0.0);
  EXPECT_GT(shareOfDifference(noisy, stressed(grey, stress, 0, true)), 0.8);
  EXPECT_GT(shareOfDifference(noisy, stressed(grey, stress, 1, false)), 0.8);
}

TEST(ImageStress, FogLeavesAShareOfTheContrast) {
  ImageStress stress;
  stress.contrast = 0.2;
  EXPECT_NEAR(contrastOf(stressed(street(), stress, 0, false)) / contrastOf(street()), 0.2, 0.01);
}

TEST(ImageStress, GainsChangeBothCamerasOrTheRightOne) {
  const cv::Mat grey(10, 10, CV_8UC1, cv::Scalar(100));
  const auto level = [&](const ImageStress& stress, int pair, bool right) {
    return cv::mean(stressed(grey, stress, pair, right))[0];
  };
  ImageStress step;
  step.gain_step = 4.0;
  EXPECT_EQ(level(step, 4, false), 50.0);
  EXPECT_EQ(level(step, 5, false), 200.0);
  EXPECT_EQ(level(step, 5, true), 200.0);
  EXPECT_EQ(level(step, 10, false), 50.0);
  ImageStress right;
  right.right_gain = 0.5;
  right.right_offset = -20.0;
  EXPECT_EQ(level(right, 0, false), 100.0);
  EXPECT_EQ(level(right, 9, true), 30.0);
}

TEST(ImageStress, TextureVanishesFromTheLeft) {
  ImageStress stress;
  stress.plain_share = 0.5;
  const cv::Mat image = stressed(street(), stress, 0, false);
  const int quarter = image.cols / 4;
  EXPECT_LT(textureOf(image.colRange(0, quarter)),
            0.25 * textureOf(street().colRange(0, quarter)));  // measured: 0.18
  const cv::Range right(3 * quarter, image.cols);
  EXPECT_EQ(shareOfDifference(image.colRange(right), street().colRange(right)), 0.0);
}

/// Drops cover what they should, stay on their lens, and differ between the lenses. In plain parts,
/// e.g. the sky, a drop is not seen.
TEST(ImageStress, DropsStayOnTheirLens) {
  cv::Mat image(200, 300, CV_8UC1);
  cv::randu(image, 0, 256);
  ImageStress stress;
  stress.drop_share = 0.3;
  const cv::Mat first = stressed(image, stress, 0, false) != image;
  EXPECT_NEAR(shareOfDifference(first, cv::Mat::zeros(first.size(), CV_8UC1)), 0.3, 0.1);
  const cv::Mat later = stressed(image, stress, 7, false) != image;
  EXPECT_EQ(shareOfDifference(first, later), 0.0);
  const cv::Mat right = stressed(image, stress, 0, true) != image;
  EXPECT_GT(shareOfDifference(first, right), 0.2);
}

TEST(ImageStress, JpegChangesMoreAtALowerQuality) {
  ImageStress good, bad;
  good.jpeg_quality = 90;
  bad.jpeg_quality = 5;
  const double small = cv::norm(stressed(street(), good, 0, false), street(), cv::NORM_L1);
  EXPECT_GT(small, 0.0);
  EXPECT_GT(cv::norm(stressed(street(), bad, 0, false), street(), cv::NORM_L1), 3.0 * small);
}

TEST(ImageStress, RefusesLevelsOutOfRange) {
  ImageStress stress;
  stress.contrast = 1.5;
  expectError<std::invalid_argument>([&] { stress.check(); }, "contrast is 1.5");
}

/// Share of an image that has a depth of 4 to 6 m.
double shareAtTheLorry(const cv::Mat& depth) {
  const cv::Mat near = (depth > 4.0) & (depth < 6.0);
  return cv::countNonZero(near) / static_cast<double>(depth.total());
}

TEST(Lorry, CoversItsShareAndMovesWithTheCamera) {
  SimulationOptions options = cleanOptions();
  options.lorry.share = 0.5;
  Simulator simulator(scenario("city", 1), options);
  const SimulatedFrame frame = simulator.render(kPair, true);
  EXPECT_NEAR(shareAtTheLorry(frame.depth), 0.5, 0.1);
  const cv::Point on_lorry(frame.depth.cols / 4, frame.depth.rows / 2);
  const cv::Point on_street(3 * frame.depth.cols / 4, frame.depth.rows - 10);
  // It keeps its place in the image but for the pitch of the camera; the road does not.
  EXPECT_LT(cv::norm(frame.flow.at<cv::Vec2d>(on_lorry)), 1.0);
  EXPECT_GT(cv::norm(frame.flow.at<cv::Vec2d>(on_street)), 5.0);
}

TEST(Lorry, ChangesLanes) {
  SimulationOptions options = cleanOptions();
  options.lorry.share = 0.5;
  options.lorry.across_mps = 1.0;
  options.frames = 0;
  const Scenario city = scenario("city", 1);
  Simulator simulator(city, options);
  const int middle = static_cast<int>(0.5 * city.drive->duration_s() * options.rate_hz);
  const SimulatedFrame frame = simulator.render(middle, true);
  const cv::Vec2d flow = frame.flow.at<cv::Vec2d>(frame.depth.rows / 2, 2);
  EXPECT_NEAR(flow[0], options.camera.fx / options.rate_hz / 5.0, 0.1);  // 5 m ahead
}

TEST(RepeatedTexture, IsAllThatIsLeft) {
  SimulationOptions options = cleanOptions();
  options.tiled_share = 1.0;
  Simulator simulator(scenario("city", 1), options);
  const SimulatedFrame tiled = simulator.render(kPair, false);
  EXPECT_GT(shareOfDifference(tiled.pair.left, street()), 0.4);
  // Three brightnesses, in light and in shade: the road has more of its own.
  EXPECT_GT(textureOf(tiled.pair.left), textureOf(street()));
}

}  // namespace
}  // namespace rotrocc
