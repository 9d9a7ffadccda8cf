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

/// Mean of an image of 100 grey levels.
double levelOf(const ImageStress& stress, int pair, bool right) {
  return cv::mean(stressed(cv::Mat(10, 10, CV_8UC1, cv::Scalar(100)), stress, pair, right))[0];
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
  for (const auto& row : rows) EXPECT_EQ(levelOf(row.stress, row.pair, row.right), row.level);
}

TEST(ImageStress, NoiseHasItsSizeAndIsOfTheSeed) {
  const ImageStress noise = stress(&ImageStress::noise_sigma, 5.0);
  const cv::Mat grey(100, 200, CV_8UC1, cv::Scalar(100));
  const cv::Mat noisy = stressed(grey, noise, 0, false);
  cv::Scalar mean, deviation;
  cv::meanStdDev(noisy, mean, deviation);
  EXPECT_NEAR(deviation[0], 5.0, 0.1);  // of 20 000 pixels: 4 sigma
  EXPECT_EQ(shareOfDifference(noisy, stressed(grey, noise, 0, false)), 0.0);
  EXPECT_GT(shareOfDifference(noisy, stressed(grey, noise, 0, true)), 0.8);
  EXPECT_GT(shareOfDifference(noisy, stressed(grey, noise, 1, false)), 0.8);
}

TEST(ImageStress, TextureVanishesFromTheLeft) {
  const cv::Mat image = stressed(street(), stress(&ImageStress::plain_share, 0.5), 0, false);
  const int quarter = image.cols / 4;
  EXPECT_LT(textureOf(image.colRange(0, quarter)),
            0.25 * textureOf(street().colRange(0, quarter)));  // measured: 0.18
  const cv::Range right(3 * quarter, image.cols);
  EXPECT_EQ(shareOfDifference(image.colRange(right), street().colRange(right)), 0.0);
}

/// In plain parts, e.g. the sky, a drop is not seen.
TEST(ImageStress, DropsStayOnTheirLens) {
  cv::Mat image(200, 300, CV_8UC1);
  cv::randu(image, 0, 256);
  const ImageStress drops = stress(&ImageStress::drop_share, 0.3);
  const cv::Mat first = stressed(image, drops, 0, false) != image;
  EXPECT_NEAR(cv::countNonZero(first) / static_cast<double>(first.total()), 0.3, 0.1);
  EXPECT_EQ(shareOfDifference(first, stressed(image, drops, 7, false) != image), 0.0);
  EXPECT_GT(shareOfDifference(first, stressed(image, drops, 0, true) != image), 0.2);
}

TEST(ImageStress, JpegChangesMoreAtALowerQuality) {
  const auto change = [](int quality) {
    ImageStress stress;
    stress.jpeg_quality = quality;
    return cv::norm(stressed(street(), stress, 0, false), street(), cv::NORM_L1);
  };
  EXPECT_GT(change(90), 0.0);
  EXPECT_GT(change(5), 3.0 * change(90));
}

TEST(ImageStress, RefusesLevelsOutOfRange) {
  expectError<std::invalid_argument>([] { stress(&ImageStress::contrast, 1.5).check(); },
                                     "contrast is 1.5");
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
