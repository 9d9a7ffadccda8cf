// Worn rigs: what calibration leaves, resampling, sensors, gains, wind and reflections.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "geometry/kitti_camera.h"
#include "simulation/drives/scenario.h"
#include "simulation/rendering/gains.h"
#include "simulation/rendering/lens.h"
#include "simulation/rendering/remainder.h"
#include "simulation/rendering/renderer.h"
#include "simulation/rendering/sensor.h"
#include "simulation/rendering/worn_rig.h"
#include "simulation/simulator.h"
#include "support/small_camera.h"

namespace rotrocc {
namespace {

constexpr int kSeeds = 8;

SimulationOptions wornOptions() {
  SimulationOptions options;
  options.camera = smallCamera();
  options.frames = 60;
  options.worn_rig = true;
  return options;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return cv::countNonZero(a != b) == 0;
}

/// Calls each(pixel) all over an image, 20 px apart.
template <typename Each>
void forPixels(const StereoCamera& camera, Each&& each) {
  for (int y = 0; y < camera.height; y += 20) {
    for (int x = 0; x < camera.width; x += 20) each(Eigen::Vector2d(x, y));
  }
}

TEST(Lens, RawAndRectifiedPlacesAreInverse) {
  const StereoCamera camera = kittiCamera();
  Lens lens;
  lens.k1 = -0.38;
  lens.k2 = 0.21;
  lens.R_raw_rectified = Eigen::AngleAxisd(0.01, Eigen::Vector3d(1, 2, 3).normalized());
  const RawImage image(lens, camera, camera.cx);
  forPixels(camera, [&](const Eigen::Vector2d& pixel) {
    const Eigen::Vector2d raw = image.raw(pixel);
    EXPECT_LT((image.rectified(raw) - pixel).norm(), 1e-6) << pixel.transpose();
    EXPECT_GT(raw.minCoeff(), 1.0);
    EXPECT_LT(raw.x(), image.size().width - 2);
    EXPECT_LT(raw.y(), image.size().height - 2);
  });
  EXPECT_GT((image.raw({0.0, 0.0}) - image.raw({0.0, 375.0})).norm(), 100.0);
}

/// Coefficients of 1, x, y, x^2, x y, y^2, x^3, x^2 y, x y^2 and y^3 in normalized coordinates, for
/// the columns and the rows.
using Field = Eigen::Matrix<double, 10, 2>;

template <typename OffsetAt>
Field fieldOf(const StereoCamera& camera, OffsetAt&& offset_at) {
  Eigen::Matrix<double, 10, 10> information = Eigen::Matrix<double, 10, 10>::Zero();
  Field sums = Field::Zero();
  forPixels(camera, [&](const Eigen::Vector2d& pixel) {
    const Eigen::Vector3d ray = camera.ray(pixel);
    const double x = ray.x();
    const double y = ray.y();
    Eigen::Matrix<double, 10, 1> terms;
    terms << 1.0, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
    information += terms * terms.transpose();
    sums += terms * offset_at(pixel).transpose();
  });
  return information.ldlt().solve(sums);
}

/// The ranges are those of four clips of KITTI.
TEST(Remainder, StereoErrorsAreLikeKittis) {
  const StereoCamera camera = kittiCamera();
  for (int seed = 0; seed < kSeeds; ++seed) {
    const StereoRemainders remainders = randomRemainders(camera, seed);
    const Field field = fieldOf(camera, [&](const Eigen::Vector2d& pixel) -> Eigen::Vector2d {
      return remainders.left.at(pixel) - remainders.right.at(pixel);
    });
    const auto columns = field.col(0);
    EXPECT_NEAR(columns[0], -0.35, 0.16) << seed;
    EXPECT_NEAR(columns[3], 1.35, 0.36) << seed;
    EXPECT_NEAR(columns[4], 1.2, 0.41) << seed;
    EXPECT_NEAR(columns[5], -10.3, 3.31) << seed;
    const auto rows = field.col(1);
    EXPECT_LT(rows.head<3>().cwiseAbs().maxCoeff(), 0.41) << seed;
    EXPECT_NEAR(rows[4], -6.85, 0.36 + 1.11) << seed;  // 0.25 px of the lenses in the corners
  }
}

TEST(Remainder, VariesByHalfToThreePixelsOverBothImages) {
  const StereoCamera camera = kittiCamera();
  for (int seed = 0; seed < kSeeds; ++seed) {
    const StereoRemainders remainders = randomRemainders(camera, seed);
    for (const bool right : {false, true}) {
      const Remainder& remainder = right ? remainders.right : remainders.left;
      const Eigen::Vector2d centre = remainder.at({right ? camera.cx_right : camera.cx, camera.cy});
      double most = 0.0;
      forPixels(camera, [&](const Eigen::Vector2d& pixel) {
        most = std::max(most, (remainder.at(pixel) - centre).norm());
      });
      EXPECT_GT(most, 0.4) << seed;
      // In the corners: 1.1 of the lens, and 0.7 of the 2.7 by which left and right may differ.
      EXPECT_LT(most, 3.0) << seed;
    }
    EXPECT_GT((remainders.left.at({0, 0}) - remainders.right.at({0, 0})).norm(), 0.05);
  }
}

/// Both principal points are wrong alike: KITTI's motions are turned by 4 to 8 mrad.
TEST(Remainder, TurnsMotionsLikeKittis) {
  const StereoCamera camera = kittiCamera();
  for (int seed = 0; seed < kSeeds; ++seed) {
    const StereoRemainders remainders = randomRemainders(camera, seed);
    const Eigen::Vector2d centre = 0.5 * (remainders.left.at({camera.cx, camera.cy}) +
                                          remainders.right.at({camera.cx_right, camera.cy}));
    // Besides, half of what the two differ by, if left and right do not have equal shares of it.
    EXPECT_NEAR(centre.norm() / camera.fx, 0.006, 0.0018 + 0.0002) << seed;
  }
}

cv::Mat smoothed(const cv::Mat& image, double sigma_px) {
  cv::Mat grey;
  image.convertTo(grey, CV_32F);
  cv::GaussianBlur(grey, grey, cv::Size(), sigma_px);
  return grey;
}

cv::Mat slope(const cv::Mat& image, bool down) {
  cv::Mat result;
  cv::Sobel(image, result, CV_32F, down ? 0 : 1, down ? 1 : 0, 3, 0.125);
  return result;
}

cv::Mat shifted(const cv::Mat& image, const Eigen::Vector2d& by_px) {
  const cv::Matx23d shift(1.0, 0.0, by_px.x(), 0.0, 1.0, by_px.y());
  cv::Mat result;
  cv::warpAffine(image, result, shift, image.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return result;
}

/// How much of the remainder beyond that of the middle, in columns and rows, makes the perfect
/// image most similar to the worn one: 1 if the texture lies where the remainder says.
Eigen::Vector2d seenShare(const cv::Mat& perfect, const cv::Mat& worn, const Remainder& remainder) {
  constexpr double kSoft = 8.0;        // grey levels per pixel
  constexpr double kOtherwise = 12.0;  // grey levels: something else has changed, e.g. a reflection
  const Eigen::Vector2d of_middle = remainder.at({0.5 * perfect.cols, 0.5 * perfect.rows});
  const cv::Mat moved = shifted(perfect, of_middle);
  const cv::Mat from = smoothed(moved, 1.5);
  // Gain and vignetting are the same all over a neighbourhood.
  const cv::Mat to = smoothed(worn, 1.5).mul(smoothed(moved, 15.0) / smoothed(worn, 15.0));
  const cv::Mat right = slope(from, false);
  const cv::Mat down = slope(from, true);
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
  Eigen::Vector2d vector = Eigen::Vector2d::Zero();
  constexpr int kMargin_px = 12;  // nothing is known beyond the border
  for (int y = kMargin_px; y < from.rows - kMargin_px; ++y) {
    for (int x = kMargin_px; x < from.cols - kMargin_px; ++x) {
      const double change = to.at<float>(y, x) - from.at<float>(y, x);
      const Eigen::Vector2d gradient(right.at<float>(y, x), down.at<float>(y, x));
      // A remainder of a pixel does not change soft texture that much.
      if (gradient.norm() > kSoft || std::abs(change) > kOtherwise) continue;
      const Eigen::Vector2d expected =
          -gradient.cwiseProduct(remainder.at(Eigen::Vector2d(x, y)) - of_middle);
      matrix += expected * expected.transpose();
      vector += change * expected;
    }
  }
  return matrix.ldlt().solve(vector);
}

TEST(WornCamera, TextureLiesWhereTheRemainderSays) {
  const Scenario city = scenario("city", 1);
  const World world(city.world);
  const StereoCamera camera = kittiCamera();
  Lens lens;
  lens.k1 = -0.35;
  lens.k2 = 0.2;
  lens.R_raw_rectified = Eigen::AngleAxisd(0.008, Eigen::Vector3d(1, 2, 3).normalized());
  Sensor sensor;
  sensor.noise_sigma = 0.0;
  const auto imageWith = [&](const Remainder& remainder) {
    const WornCamera worn(camera, camera.cx, lens, remainder, sensor);
    const Picture picture = render(world, {}, worn.rays(), city.drive->pose(0.0));
    return worn.develop(picture.brightness, 1.0, 0);
  };
  const cv::Mat without = imageWith(Remainder(Remainder::Coefficients::Zero(), camera, camera.cx));
  for (const std::uint64_t seed : {1, 2}) {
    const Remainder remainder = randomRemainders(camera, seed).left;
    const Eigen::Vector2d share = seenShare(without, imageWith(remainder), remainder);
    // Texture is not linear over a pixel.
    EXPECT_NEAR(share.x(), 1.0, 0.1);
    EXPECT_NEAR(share.y(), 1.0, 0.1);
  }
  // And without one, where the nominal camera has it.
  const cv::Mat perfect = develop(
      render(world, {}, {camera, {}, 1.0}, city.drive->pose(0.0)).brightness, sensor, 1.0, 0);
  Remainder::Coefficients any = Remainder::Coefficients::Zero();
  any.rightCols<7>().setConstant(0.3);
  EXPECT_LT(seenShare(perfect, without, Remainder(any, camera, camera.cx)).norm(), 0.1);
}

/// Stereo pairs of a worn rig differ from those of a perfect one by both remainders.
TEST(WornRig, BothImagesHaveTheirRemainder) {
  SimulationOptions options = wornOptions();
  options.camera = kittiCamera();
  Simulator worn(scenario("city", 1), options);
  options.worn_rig = false;
  Simulator perfect(scenario("city", 1), options);
  const SimulatedFrame with = worn.render(0, false);
  const SimulatedFrame without = perfect.render(0, false);
  const StereoRemainders remainders = randomRemainders(options.camera, options.seed);
  // Reflections and leaves have other places in the two.
  const double left = seenShare(without.pair.left, with.pair.left, remainders.left).sum();
  const double right = seenShare(without.pair.right, with.pair.right, remainders.right).sum();
  EXPECT_NEAR(left, 2.0, 0.8);
  EXPECT_NEAR(right, 2.0, 0.8);
}

TEST(WornRig, TruthStaysThatOfTheNominalCamera) {
  SimulationOptions options = wornOptions();
  Simulator worn(scenario("city", 1), options);
  options.worn_rig = false;
  Simulator perfect(scenario("city", 1), options);
  EXPECT_EQ(worn.camera(), perfect.camera());
  EXPECT_TRUE(worn.pose(40).isApprox(perfect.pose(40), 0.0));
  const SimulatedFrame with = worn.render(40, true);
  const SimulatedFrame without = perfect.render(40, true);
  // Leaves in the wind show and hide what is behind.
  EXPECT_LT(cv::countNonZero(with.depth != without.depth), 0.03 * with.depth.total());
  EXPECT_TRUE(worn.render(40, false).depth.empty());
}

TEST(WornRig, SameBytesForASeedAndAnotherRigForAnother) {
  Simulator simulator(scenario("city", 3), wornOptions());
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const SimulatedFrame one = simulator.render(20, false);
  cv::setNumThreads(4);
  simulator.render(21, false);
  const SimulatedFrame four = simulator.render(20, false);
  cv::setNumThreads(threads);
  Simulator again(scenario("city", 3), wornOptions());
  const SimulatedFrame rebuilt = again.render(20, false);
  for (const SimulatedFrame& other : {four, rebuilt}) {
    EXPECT_TRUE(same(one.pair.left, other.pair.left));
    EXPECT_TRUE(same(one.pair.right, other.pair.right));
  }
  SimulationOptions options = wornOptions();
  options.seed = 4;
  Simulator other(scenario("city", 3), options);  // in the same street
  EXPECT_FALSE(same(one.pair.left, other.render(20, false).pair.left));
  const WornRig first = wornRig(smallCamera(), 3);
  const WornRig second = wornRig(smallCamera(), 4);
  EXPECT_NE(first.exposure_s, second.exposure_s);
  EXPECT_NE(first.weather.wind.reach_m, second.weather.wind.reach_m);
  EXPECT_NE(first.gains.at(1.0, false), second.gains.at(1.0, false));
}

TEST(Sensor, NoiseGrowsWithTheRootOfTheLight) {
  Sensor sensor;
  sensor.vignetting = 0.0;
  sensor.noise_sigma = 0.0;
  sensor.full_well_e = 4000.0;
  sensor.read_noise_e = 10.0;
  for (const double light : {0.05, 0.2, 0.6}) {
    const cv::Mat image = develop(cv::Mat(300, 300, CV_32FC1, cv::Scalar(light)), sensor, 1.0, 7);
    cv::Mat grey;
    image.convertTo(grey, CV_64F, 1.0 / 255.0);
    cv::pow(grey, 1.0 / 0.8, grey);  // back to light
    cv::Scalar mean, deviation;
    cv::meanStdDev(grey, mean, deviation);
    const double step = std::pow(light, 0.2) / (0.8 * 255.0);  // of a grey level
    const double variance = light / 4000.0 + 10.0 * 10.0 / (4000.0 * 4000.0) + step * step / 12.0;
    EXPECT_NEAR(mean[0], light, 0.002);
    EXPECT_NEAR(deviation[0], std::sqrt(variance), 0.03 * std::sqrt(variance)) << light;
  }
}

/// Noise of two renderings of a frame with different noise, where it is not white.
struct Noise {
  double dark_sigma;
  double light_sigma;
  double correlation;  // of neighbours
};

Noise noiseOf(SimulationOptions options) {
  options.noise_seed = 2;
  const cv::Mat one = Simulator(scenario("city", 1), options).render(5, false).pair.left;
  options.noise_seed = 3;
  const cv::Mat other = Simulator(scenario("city", 1), options).render(5, false).pair.left;
  double dark = 0.0, light = 0.0, product = 0.0;
  int darks = 0, lights = 0;
  for (int y = 0; y < one.rows; ++y) {
    for (int x = 0; x + 1 < one.cols; ++x) {
      const double difference = one.at<uchar>(y, x) - other.at<uchar>(y, x);
      const int grey = one.at<uchar>(y, x);
      if ((grey >= 50 && grey < 100) || grey > 200) continue;
      (grey < 50 ? dark : light) += difference * difference;
      ++(grey < 50 ? darks : lights);
      product += difference * (one.at<uchar>(y, x + 1) - other.at<uchar>(y, x + 1));
    }
  }
  return {std::sqrt(0.5 * dark / darks), std::sqrt(0.5 * light / lights), product / (dark + light)};
}

TEST(WornRig, NoiseOfNeighboursIsCorrelatedAndGrowsWithLight) {
  SimulationOptions options = wornOptions();
  const Noise worn = noiseOf(options);
  options.worn_rig = false;
  const Noise perfect = noiseOf(options);
  EXPECT_NEAR(perfect.correlation, 0.0, 0.02);
  EXPECT_GT(worn.correlation, 0.1);  // bilinear: 0.25 in the mean over all phases
  EXPECT_LT(worn.correlation, 0.4);
  EXPECT_NEAR(perfect.light_sigma, perfect.dark_sigma, 0.05 * perfect.dark_sigma);
  EXPECT_GT(worn.light_sigma, 1.1 * worn.dark_sigma);
}

TEST(Gains, OutOfStepMovesEachCameraForItself) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Gains gains = outOfStepGains(seed);
    double least = 1.0, most = 1.0, least_ratio = 1.0, most_ratio = 1.0;
    for (double time = 0.0; time < 10.0; time += 0.05) {
      const double left = gains.at(time, false);
      const double right = gains.at(time, true);
      least = std::min({least, left, right});
      most = std::max({most, left, right});
      least_ratio = std::min(least_ratio, right / left);
      most_ratio = std::max(most_ratio, right / left);
    }
    EXPECT_NEAR(least, 0.5, 0.01);
    EXPECT_NEAR(most, 1.0, 0.01);
    EXPECT_LT(least_ratio, 0.7) << seed;
    EXPECT_GT(most_ratio, 1.4) << seed;
  }
}

TEST(Gains, OfARigDriftBySomePercent) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Gains gains = driftingGains(seed);
    for (double time = 0.0; time < 20.0; time += 0.5) {
      EXPECT_NEAR(gains.at(time, false), 1.0, 0.28);
      EXPECT_NEAR(gains.at(time, true) / gains.at(time, false), 1.0, 0.25);
    }
  }
}

TEST(Gains, AreSeenInTheImages) {
  SimulationOptions options = wornOptions();
  options.worn_rig = false;
  options.faults.sensor.noise_sigma = 0.0;
  Simulator steady(scenario("city", 1), options);
  options.gains_out_of_step = true;
  Simulator moving(scenario("city", 1), options);
  const Gains gains = outOfStepGains(options.seed);
  const cv::Rect below_the_sky(0, 50, 310, 44);
  for (const int frame : {3, 20, 41}) {
    const SimulatedFrame with = moving.render(frame, false);
    const SimulatedFrame without = steady.render(frame, false);
    const double time_s = 1e-9 * moving.stamp_ns(frame);
    for (const bool right : {false, true}) {
      const cv::Mat& a = right ? with.pair.right : with.pair.left;
      const cv::Mat& b = right ? without.pair.right : without.pair.left;
      const double ratio = cv::mean(a(below_the_sky))[0] / cv::mean(b(below_the_sky))[0];
      EXPECT_NEAR(ratio, std::pow(gains.at(time_s, right), 0.8), 0.02);  // response of the camera
    }
  }
}

/// A street from a camera that stands.
class StandingTest : public ::testing::Test {
 protected:
  Picture at(const Weather& weather, double time_s) const {
    Scenario city = scenario("city", 1);
    city.world.weather = weather;
    World world(city.world);
    world.setTime(time_s);
    return render(world, {}, {smallCamera(), {}, 1.0}, city.drive->pose(0.0));
  }

  static double changedShare(const Picture& a, const Picture& b) {
    const cv::Mat changed = cv::abs(a.brightness - b.brightness) > 0.01;
    return cv::countNonZero(changed) / static_cast<double>(changed.total());
  }
};

TEST_F(StandingTest, WindMovesPartOfTheImage) {
  Weather weather = windyWeather(1);
  weather.reflections = false;
  const Picture before = at(weather, 0.0);
  const double moved = changedShare(before, at(weather, 0.1));
  EXPECT_GT(moved, 0.005);
  EXPECT_LT(moved, 0.5);
  EXPECT_EQ(changedShare(before, at(weather, 0.0)), 0.0);
  EXPECT_EQ(changedShare(at({}, 0.0), at({}, 0.1)), 0.0);
}

TEST_F(StandingTest, ReflectionsAreOnPartOfTheImage) {
  Weather weather;
  const Picture without = at(weather, 0.0);
  weather.reflections = true;
  const Picture with = at(weather, 0.0);
  const double mirroring = changedShare(without, with);
  EXPECT_GT(mirroring, 0.01);
  EXPECT_LT(mirroring, 0.5);
  EXPECT_TRUE(same(with.depth, without.depth));
}

TEST(Wind, LeavesStayWithinItsReach) {
  const Weather weather = windyWeather(5);
  double most = 0.0;
  for (double time = 0.0; time < 3.0; time += 0.1) {
    Wind wind = weather.wind;
    wind.time_s = time;
    for (double x = 0.0; x < 5.0; x += 0.5) most = std::max(most, wind.sway({x, 2.0}).norm());
  }
  EXPECT_LE(most, 1.2 * weather.wind.reach_m);
  EXPECT_GT(most, 0.8 * weather.wind.reach_m);
  EXPECT_EQ(Wind().sway({1.0, 2.0}).norm(), 0.0);
}

/// Mean along the path: an edge that moves by 4 px becomes a ramp of 4 px.
TEST(MotionBlur, SmearsAnEdgeOverItsPath) {
  const StereoCamera camera = smallCamera();
  const cv::Size size(camera.width, camera.height);
  Picture picture = {cv::Mat(size, CV_32FC1, cv::Scalar(0.0)),
                     cv::Mat(size, CV_64FC1, cv::Scalar(10.0)),
                     cv::Mat(size, CV_32SC1, cv::Scalar(-1))};
  picture.brightness(cv::Rect(100, 0, 100, camera.height)).setTo(1.0);
  Eigen::Isometry3d shift = Eigen::Isometry3d::Identity();
  shift.translation().x() = 4.0 * 10.0 / camera.fx;
  const cv::Mat result = blurred(picture, {camera, {}, 1.0}, {shift});
  EXPECT_EQ(result.at<float>(40, 96), 0.0F);
  EXPECT_EQ(result.at<float>(40, 104), 1.0F);
  // Six taps on a path of 4 px.
  EXPECT_NEAR(result.at<float>(40, 99) + result.at<float>(40, 100), 1.0, 1e-4);
  EXPECT_NEAR(result.at<float>(40, 100), 0.625, 0.1);
  const cv::Mat still = blurred(picture, {camera, {}, 1.0}, {Eigen::Isometry3d::Identity()});
  EXPECT_TRUE(same(still, picture.brightness));
}

}  // namespace
}  // namespace rotrocc
