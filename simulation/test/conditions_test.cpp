// Night, rain and a field, at a quarter of KITTI's size.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>

#include "simulation/drives/scenario.h"
#include "simulation/rendering/rain.h"
#include "simulation/rendering/renderer.h"
#include "simulation/rendering/sensor.h"
#include "simulation/simulator.h"
#include "simulation/surfaces/lighting.h"
#include "simulation/truth_check.h"
#include "support/expect_error.h"
#include "support/small_camera.h"

namespace rotrocc {
namespace {

constexpr double kDegree = M_PI / 180.0;

SimulationOptions smallOptions() {
  SimulationOptions options;
  options.camera = smallCamera();
  options.moving_share = 1.0;
  return options;
}

/// Without the noise and blur of the cameras.
Scenario seenPerfectly(Scenario scenario) {
  scenario.exposure = {};
  return scenario;
}

SimulationOptions perfectOptions() {
  SimulationOptions options = smallOptions();
  options.faults.sensor.noise_sigma = 0.0;
  options.faults.sensor.vignetting = 0.0;
  return options;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return cv::countNonZero(a != b) == 0;
}

class ConditionsTest : public ::testing::TestWithParam<std::string> {};

TEST_P(ConditionsTest, PosesDepthAndFlowAreExact) {
  Simulator simulator(scenario(GetParam(), 1), smallOptions());
  constexpr int kFrame = 40;
  TruthErrors errors;
  checkTruth(simulator, kFrame, simulator.render(kFrame, true), errors);
  EXPECT_GT(errors.right, 1000);
  EXPECT_LT(errors.wrong, 0.02 * errors.right);  // edges and leaves
  EXPECT_LT(errors.sum_px / errors.right, 1e-4);
}

TEST_P(ConditionsTest, SameBytesWhateverTheThreadCount) {
  for (const bool worn : {false, true}) {
    SimulationOptions options = smallOptions();
    options.worn_rig = worn;
    Simulator simulator(scenario(GetParam(), 2), options);
    const int threads = cv::getNumThreads();
    cv::setNumThreads(1);
    const SimulatedFrame one = simulator.render(20, true);
    cv::setNumThreads(3);
    simulator.render(21, false);
    const SimulatedFrame three = simulator.render(20, true);
    cv::setNumThreads(threads);
    EXPECT_TRUE(same(one.pair.left, three.pair.left)) << worn;
    EXPECT_TRUE(same(one.pair.right, three.pair.right)) << worn;
    EXPECT_TRUE(same(one.depth, three.depth)) << worn;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenarios,
                         ConditionsTest,
                         ::testing::Values("night", "rain", "field"),
                         [](const auto& name) { return name.param; });

TEST(HeadLamps, LightFallsWithDistanceAndBesideTheCone) {
  HeadLamps lamps;
  lamps.brightness = 1.0;
  const Eigen::Vector3d facing = -Eigen::Vector3d::UnitZ();
  const auto light = [&](double x, double below, double z) {
    return headLight(lamps, lamps.middle_m + Eigen::Vector3d(x, below, z), facing);
  };
  const double at_10_m = light(0.0, 0.5, 10.0);
  EXPECT_NEAR(at_10_m, 1.0, 0.1);
  // The inverse square of the distance; the two lamps are apart, and the beam is not even.
  EXPECT_NEAR(light(0.0, 1.0, 20.0), 0.25 * at_10_m, 0.02);
  EXPECT_NEAR(light(0.0, 2.0, 40.0), 0.0625 * at_10_m, 0.005);
  EXPECT_LT(light(10.0, 0.5, 10.0), 0.1 * at_10_m);
  EXPECT_LT(light(0.0, -1.0, 10.0), 0.05 * at_10_m);  // above the cut-off
  EXPECT_EQ(light(0.0, 0.5, -10.0), 0.0);
  EXPECT_EQ(headLight(lamps, lamps.middle_m + Eigen::Vector3d(0.0, 0.5, 10.0), -facing), 0.0);
}

/// Mean grey level of what is from `near_m` to `far_m` away in the lower half of an image.
double meanBetween(const SimulatedFrame& frame, double near_m, double far_m) {
  const int half = frame.depth.rows / 2;
  const cv::Mat depth = frame.depth.rowRange(half, frame.depth.rows);
  const cv::Mat in_range = (depth >= near_m) & (depth < far_m);
  return cv::mean(frame.pair.left.rowRange(half, frame.depth.rows), in_range)[0];
}

TEST(Night, OwnLampsLightWhatIsNear) {
  Scenario night = seenPerfectly(scenario("night", 1));
  night.world.lighting.street_lamps = 0.0;
  night.world.lighting.lights = 0.0;
  SimulationOptions options = perfectOptions();
  options.moving_share = 0.0;
  Simulator lit(night, options);
  const SimulatedFrame with = lit.render(50, false);
  EXPECT_GT(meanBetween(with, 4.0, 8.0), 1.5 * meanBetween(with, 10.0, 20.0));
  EXPECT_GT(meanBetween(with, 10.0, 20.0), 1.5 * meanBetween(with, 30.0, 60.0));

  night.world.lighting.head_lamps.brightness = 0.0;
  Simulator dark(night, options);
  EXPECT_LT(cv::mean(dark.render(50, false).pair.left)[0], 8.0);
}

TEST(Night, StreetLampsLightTheStreet) {
  Scenario night = seenPerfectly(scenario("night", 1));
  night.world.lighting.head_lamps.brightness = 0.0;
  Simulator lit(night, perfectOptions());
  night.world.lighting.street_lamps = 0.0;
  Simulator dark(night, perfectOptions());
  const SimulatedFrame with = lit.render(50, false);
  const SimulatedFrame without = dark.render(50, false);
  EXPECT_GT(meanBetween(with, 10.0, 40.0), 2.0 * meanBetween(without, 10.0, 40.0));
  double most = 0.0;
  cv::minMaxLoc(with.pair.left, nullptr, &most);
  EXPECT_EQ(most, 255.0);  // a lamp or the lights of a car
}

/// Standard deviation of the grey levels of a picture that is `light` all over.
double noiseOf(const Sensor& sensor, double light) {
  const cv::Mat even(100, 100, CV_32FC1, cv::Scalar(light));
  cv::Scalar mean, deviation;
  cv::meanStdDev(develop(even, sensor, 1.0, 7), mean, deviation);
  return deviation[0];
}

TEST(Night, NoiseIsThatOfFewElectrons) {
  Sensor day;
  day.noise_sigma = 0.0;
  day.vignetting = 0.0;
  day.full_well_e = 4000.0;
  day.read_noise_e = 8.0;
  const Exposure exposure = scenario("night", 1).exposure;
  EXPECT_GT(exposure.time_s, 0.01);
  const Sensor night = exposure.of(day);
  EXPECT_DOUBLE_EQ(night.full_well_e * exposure.gain, day.full_well_e);
  for (const double light : {0.1, 0.3}) {
    const double electrons = light * night.full_well_e;
    const double sigma = std::sqrt(electrons + 64.0) / night.full_well_e;
    const double slope = 255.0 * 0.8 * std::pow(light, -0.2);  // of the response
    // 10000 pixels; the response bends within the noise.
    EXPECT_NEAR(noiseOf(night, light), slope * sigma, 0.1 * slope * sigma) << light;
    EXPECT_GT(noiseOf(night, light), 2.5 * noiseOf(day, light)) << light;
  }
  Sensor even;  // a perfect camera has no less noise at night
  even.noise_sigma = 0.0;
  EXPECT_DOUBLE_EQ(exposure.of(even).full_well_e, night.full_well_e);
  EXPECT_EQ(Exposure().of(even).full_well_e, 0.0);
}

TEST(Night, LongExposuresBlurWhatMoves) {
  Scenario night = seenPerfectly(scenario("night", 1));
  Simulator sharp(night, perfectOptions());
  night.exposure.time_s = 0.04;
  Simulator blurred(night, perfectOptions());
  const auto detail = [](const cv::Mat& image) {
    const cv::Mat left = image.colRange(0, image.cols - 1);
    return cv::norm(left, image.colRange(1, image.cols), cv::NORM_L1);
  };
  EXPECT_LT(detail(blurred.render(50, false).pair.left),
            0.95 * detail(sharp.render(50, false).pair.left));
}

TEST(LensDrops, StayUntilTheyAreWiped) {
  constexpr double kStep_s = 0.1;
  constexpr double kFastest_px = 0.02 * 1241 * kStep_s * 1.001;
  const cv::Size image(1241, 376);
  Rain rain;
  rain.drops = 60.0;
  rain.wiped_every_s = 5.0;
  int wipes = 0;
  int still = 0;
  int creeping = 0;
  std::size_t most = 0;
  for (double time = 0.0; time < 20.0; time += kStep_s) {
    const auto now = dropsOnLens(rain, image, time, 3);
    const auto next = dropsOnLens(rain, image, time + kStep_s, 3);
    most = std::max(most, now.size());
    if (next.size() < now.size()) {
      ++wipes;
      EXPECT_LT(next.size(), 8U);  // of those that fell within a tenth of a second
      continue;
    }
    for (const LensDrop& drop : now) {
      const auto moved = [&](const LensDrop& other) {
        return other.radius == drop.radius ? (other.centre - drop.centre).norm() : 1e9;
      };
      double least = 1e9;
      for (const LensDrop& other : next) least = std::min(least, moved(other));
      EXPECT_LT(least, kFastest_px);
      least == 0.0 ? ++still : ++creeping;
    }
  }
  EXPECT_EQ(wipes, 4);
  EXPECT_GT(most, 50U);
  EXPECT_GT(still, 4 * creeping);
  EXPECT_GT(creeping, 0);
}

double overlap(const cv::Mat& a, const cv::Mat& b) {
  return static_cast<double>(cv::countNonZero(a & b)) / std::max(1, cv::countNonZero(a | b));
}

/// Where drops change the images of a city in the rain, from one frame to the next.
TEST(Rain, DropsStayAtTheirPixelsWhileTheSceneMoves) {
  Scenario rain = seenPerfectly(scenario("rain", 1));
  rain.rain.streaks = 0.0;
  rain.rain.wiped_every_s = 100.0;
  Simulator wet(rain, perfectOptions());
  rain.rain.drops = 0.0;
  Simulator dry(rain, perfectOptions());
  const auto changed = [&](int frame, bool right) -> cv::Mat {
    const StereoPair with = wet.render(frame, false).pair;
    const StereoPair without = dry.render(frame, false).pair;
    cv::Mat difference;
    cv::absdiff(right ? with.right : with.left, right ? without.right : without.left, difference);
    return difference > 4.0;
  };
  const int last = wet.size() - 20;
  const cv::Mat now = changed(last, false);
  const double share = cv::countNonZero(now) / static_cast<double>(now.total());
  EXPECT_GT(share, 0.005);
  EXPECT_LT(share, 0.2);
  // A drop may look like what is behind it.
  EXPECT_GT(overlap(now, changed(last + 1, false)), 0.7);
  EXPECT_LT(overlap(now, changed(last, true)), 0.3);
}

TEST(Rain, StreaksAreSeenInBothImagesWithTheirDisparity) {
  const StereoCamera camera = smallCamera();
  const PixelRays rays = {camera, {}};
  const cv::Mat black(camera.height, camera.width, CV_32FC1, cv::Scalar(0.0));
  const Eigen::Vector3d at(0.2, 0.0, 2.0);
  const Eigen::Vector3d half_way(0.0, 0.02, 0.0);
  const auto column = [&](const Eigen::Vector3d& shift) {
    const cv::Mat image =
        throughStreaks(black, rays, {{at + shift - half_way, at + shift + half_way, 0.004}}, 1.0);
    double sum = 0.0;
    double moment = 0.0;
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        sum += image.at<float>(y, x);
        moment += x * image.at<float>(y, x);
      }
    }
    EXPECT_GT(sum, 0.1);
    return moment / sum;
  };
  const double disparity = column(Eigen::Vector3d::Zero()) - column({-camera.baseline_m, 0.0, 0.0});
  EXPECT_NEAR(disparity, camera.disparity(at.z()), 0.5);
}

TEST(Rain, StreaksGetLongerWithTheExposureAndFollowTheRide) {
  Rain rain;
  rain.streaks = 50.0;
  const Eigen::Vector3d way(0.0, 0.05, -0.1);  // falls, and comes towards the camera
  const auto streaks = fallingDrops(rain, smallCamera(), way, 5);
  ASSERT_EQ(streaks.size(), 50U);
  for (const Streak& streak : streaks) {
    EXPECT_TRUE((streak.to - streak.from).isApprox(way));
    EXPECT_LT(streak.from.z(), 6.1);
  }
}

TEST(Rain, MistTakesContrastWithDistance) {
  Scenario rain = seenPerfectly(scenario("rain", 1));
  rain.rain = {};
  Simulator misty(rain, perfectOptions());
  rain.world.weather.visibility_m = std::numeric_limits<double>::infinity();
  Simulator clear(rain, perfectOptions());
  const SimulatedFrame with = misty.render(30, false);
  const SimulatedFrame without = clear.render(30, false);
  const auto change = [&](double near_m, double far_m) {
    return std::abs(meanBetween(with, near_m, far_m) - meanBetween(without, near_m, far_m));
  };
  // A ray of 10 m: 6 % of the way to the brightness of the sky.
  EXPECT_LT(change(4.0, 8.0), 0.06 * 255.0);
  EXPECT_GT(change(40.0, 80.0), 2.0 * change(4.0, 8.0));
}

TEST(Rain, WaterOnTheRoadMirrors) {
  Scenario rain = seenPerfectly(scenario("rain", 1));
  rain.rain = {};
  Simulator wet(rain, perfectOptions());
  rain.world.weather.wet = 0.0;
  Simulator dry(rain, perfectOptions());
  cv::Mat change;
  cv::absdiff(wet.render(30, false).pair.left, dry.render(30, false).pair.left, change);
  const int half = change.rows / 2;
  EXPECT_EQ(cv::countNonZero(change.rowRange(0, half - 10)), 0);  // above the horizon
  EXPECT_GT(cv::mean(change.rowRange(half, change.rows))[0], 3.0);
}

TEST(Rain, RefusesValuesOutOfRange) {
  Scenario rain = scenario("rain", 1);
  rain.rain.drops = -1.0;
  expectError<std::invalid_argument>([&] { Simulator simulator(rain, smallOptions()); },
                                     "number of drops is -1");
}

TEST(Field, RoverRollsAndPitchesNearTheGround) {
  const Scenario field = scenario("field", 1);
  Simulator simulator(field, smallOptions());
  double most_roll = 0.0;
  double most_pitch = 0.0;
  double mean_down = 0.0;
  int count = 0;
  for (double time = 0.0; time < field.drive->duration_s(); time += 0.1, ++count) {
    const Eigen::Isometry3d pose = field.drive->pose(time);
    const Eigen::Vector3d at = pose.translation();
    const double height = simulator.world().terrain().height(at.x(), at.z()) - at.y();
    EXPECT_GT(height, 0.5) << time;
    EXPECT_LT(height, 0.8) << time;
    const double down = std::asin(pose.linear()(1, 2));
    mean_down += down;
    most_pitch = std::max(most_pitch, std::abs(down - 8.0 * kDegree));
    most_roll = std::max(most_roll, std::abs(std::asin(pose.linear()(1, 0))));
    const double speed = (field.drive->pose(time + 0.01).translation() - at).norm() / 0.01;
    EXPECT_GT(speed, 0.4) << time;
    EXPECT_LT(speed, 1.1) << time;
  }
  EXPECT_NEAR(mean_down / count, 8.0 * kDegree, 1.0 * kDegree);
  EXPECT_GT(most_roll, 1.5 * kDegree);
  EXPECT_LT(most_roll, 4.0 * kDegree);
  EXPECT_GT(most_pitch, 2.0 * kDegree);
  EXPECT_LT(most_pitch, 8.0 * kDegree);  // with the slope of the track
}

}  // namespace
}  // namespace rotrocc
