// Places beside the streets: what they show, and that their truth is exact.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "simulation/drives/scenario.h"
#include "simulation/rendering/renderer.h"
#include "simulation/rendering/worn_rig.h"
#include "simulation/simulator.h"
#include "simulation/truth_check.h"

namespace rotrocc {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// The camera of EuRoC, at a third of its size.
SimulationOptions smallOptions() {
  SimulationOptions options;
  options.camera = {};
  options.camera.width = 250;
  options.camera.height = 160;
  options.camera.fx = options.camera.fy = 153.0;
  options.camera.cx = options.camera.cx_right = 124.5;
  options.camera.cy = 79.5;
  options.camera.baseline_m = 0.11;
  options.rate_hz = 20.0;
  return options;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return cv::countNonZero(a != b) == 0;
}

/// Rate at which the camera turns about the vertical [rad/s], positive to the right.
double yawRate(const Drive& drive, double time_s) {
  constexpr double kStep_s = 0.01;
  const auto heading = [&](double t) {
    const Eigen::Vector3d ahead = drive.pose(t).linear().col(2);
    return std::atan2(ahead.x(), ahead.z());
  };
  return std::remainder(heading(time_s + kStep_s) - heading(time_s), 2.0 * M_PI) / kStep_s;
}

class PlacesTest : public ::testing::TestWithParam<std::string> {};

TEST_P(PlacesTest, TruthHoldsAllAlong) {
  for (const bool worn : {false, true}) {
    SimulationOptions options = smallOptions();
    options.worn_rig = worn;
    Simulator simulator(scenario(GetParam(), 1), options);
    TruthErrors errors;
    for (int i = 0; i + 1 < simulator.size(); i += simulator.size() / 12) {
      checkTruth(simulator, i, simulator.render(i, true), errors);
    }
    EXPECT_GT(errors.right, 15000);
    EXPECT_LT(errors.wrong, 0.005 * errors.right);  // edges
    EXPECT_LT(errors.sum_px / errors.right, 1e-4);
  }
}

TEST_P(PlacesTest, SameSeedSameBytesWhateverTheThreadCount) {
  const int threads = cv::getNumThreads();
  const auto frame = [](std::uint64_t seed, int thread_count) {
    cv::setNumThreads(thread_count);
    SimulationOptions options = smallOptions();
    options.seed = seed;
    Simulator simulator(scenario(GetParam(), seed), options);
    return simulator.render(simulator.size() / 2, false);
  };
  const SimulatedFrame one = frame(1, 1);
  const SimulatedFrame four = frame(1, 4);
  const SimulatedFrame other = frame(2, 4);
  cv::setNumThreads(threads);
  EXPECT_TRUE(same(one.pair.left, four.pair.left));
  EXPECT_TRUE(same(one.pair.right, four.pair.right));
  EXPECT_TRUE(same(one.depth, four.depth));
  EXPECT_FALSE(same(one.depth, other.depth));
}

TEST_P(PlacesTest, ImagesAreNeitherBlackNorWhite) {
  Simulator simulator(scenario(GetParam(), 1), smallOptions());
  for (int i = 0; i < simulator.size(); i += simulator.size() / 8) {
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(simulator.render(i, false).pair.left, mean, deviation);
    EXPECT_GT(mean[0], 30.0) << i;
    EXPECT_LT(mean[0], 170.0) << i;
    EXPECT_GT(deviation[0], 15.0) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Places,
                         PlacesTest,
                         ::testing::Values("hall", "walk", "tunnel"),
                         [](const auto& name) { return name.param; });

TEST(Hall, IsClosed) {
  Simulator simulator(scenario("hall", 1), smallOptions());
  for (int i = 0; i < simulator.size(); i += 20) {
    const cv::Mat depth = simulator.render(i, false).depth;
    double least = 0.0;
    double most = 0.0;
    cv::minMaxLoc(depth, &least, &most);
    EXPECT_LT(most, 35.0) << i;  // its diagonal is 29 m
    EXPECT_GT(least, 0.2) << i;
  }
}

TEST(Hall, AWallIsHalfAMetreAway) {
  Simulator simulator(scenario("hall", 1), smallOptions());
  const StereoCamera& camera = simulator.camera();
  double nearest = 1e9;
  for (int i = 380; i < 440; i += 10) {
    const cv::Mat depth = simulator.render(i, false).depth;
    for (int y = 0; y < depth.rows; y += 10) {
      for (int x = 0; x < depth.cols; x += 10) {
        const Eigen::Vector3d ray = camera.ray(Eigen::Vector2d(x, y));
        nearest = std::min(nearest, depth.at<double>(y, x) * ray.norm());
      }
    }
  }
  EXPECT_LT(nearest, 0.6);
  EXPECT_GT(nearest, 0.4);
}

TEST(Hall, IsFlownInSixDegreesOfFreedom) {
  const Scenario hall = scenario("hall", 1);
  double fastest = 0.0;
  double highest = 0.0;
  double steepest = 0.0;
  for (double t = 0.0; t < hall.drive->duration_s(); t += 0.02) {
    const Eigen::Isometry3d pose = hall.drive->pose(t);
    fastest = std::max(fastest, std::abs(yawRate(*hall.drive, t)));
    highest = std::max(highest, -pose.translation().y());
    steepest = std::max(steepest, std::abs(std::asin(pose.linear()(1, 0))));
  }
  EXPECT_GT(fastest, 90.0 * kDegree);
  EXPECT_LT(fastest, 150.0 * kDegree);
  EXPECT_GT(highest, 2.5);
  EXPECT_GT(steepest, 10.0 * kDegree);  // it banks
  const double moved =
      (hall.drive->pose(4.8).translation() - hall.drive->pose(3.4).translation()).norm();
  EXPECT_GT(moved, 1e-3);  // hovers
  EXPECT_LT(moved, 0.2);
}

TEST(Walk, ClimbsAStair) {
  const Scenario walk = scenario("walk", 1);
  const double start = walk.drive->pose(0.0).translation().y();
  double last = start;
  for (double t = 10.5; t < 18.8; t += 1.0) {
    const double height = walk.drive->pose(t).translation().y();
    EXPECT_LT(height, last + 0.03) << t;  // the head bobs
    last = height;
  }
  EXPECT_NEAR(start - walk.drive->pose(20.0).translation().y(), 16 * 0.17, 0.1);
}

/// The steps are solid: seen from above, the height below the camera changes by one rise at a time.
TEST(Walk, TheStairHasSteps) {
  const World world(scenario("walk", 1).world);
  const SceneGeometry scene(world.terrain(), world.bodies());
  double last = 0.0;
  int risers = 0;
  for (double z = 11.5; z < 18.0; z += 0.02) {
    SceneHit hit;
    const Ray down = {{-0.2, -4.0, z}, Eigen::Vector3d::UnitY()};
    ASSERT_TRUE(scene.trace(down, {0.0, 10.0}, 0.001, hit));
    const double height = 4.0 - hit.at.distance;
    if (height - last > 0.01) {
      EXPECT_NEAR(height - last, 0.17, 1e-6) << z;
      ++risers;
    }
    last = height;
  }
  EXPECT_EQ(risers, 16);
  EXPECT_NEAR(last, 16 * 0.17, 1e-9);
}

TEST(Walk, TurnsOnTheSpot) {
  const Scenario walk = scenario("walk", 1);
  double turned = 0.0;
  double fastest = 0.0;
  for (double t = 24.8; t < 28.6; t += 0.01) {
    const double rate = yawRate(*walk.drive, t);
    turned += 0.01 * rate;
    fastest = std::max(fastest, rate);
    // The feet stand; the camera is in front of the axis that turns.
    const Eigen::Isometry3d pose = walk.drive->pose(t);
    const Eigen::Vector3d axis = pose * Eigen::Vector3d(0.05, 0.1, -0.12);
    EXPECT_LT(std::hypot(axis.x(), axis.z() - 24.0), 0.06) << t;
  }
  EXPECT_NEAR(turned, M_PI, 5.0 * kDegree);
  EXPECT_GT(fastest, 75.0 * kDegree);
}

/// Median difference between what cameras see from two places in the straight part of the tunnel.
double differenceAfter(const World& world, double way_m) {
  const auto look = [&](double z) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().z() = z;
    return render(world, {}, {smallOptions().camera, {}}, pose).brightness;
  };
  const cv::Mat here = look(-100.0);
  const cv::Mat there = look(-100.0 + way_m);
  std::vector<float> differences;
  for (int y = 0; y < here.rows; ++y) {
    for (int x = 0; x < here.cols; ++x) {
      differences.push_back(std::abs(here.at<float>(y, x) - there.at<float>(y, x)));
    }
  }
  const auto middle = differences.begin() + differences.size() / 2;
  std::nth_element(differences.begin(), middle, differences.end());
  return *middle;
}

TEST(Tunnel, RepeatsItself) {
  const World world(scenario("tunnel", 1).world);
  const double other = differenceAfter(world, 3.7);
  // Two segments are a period of the lamps; only the road, signs and doors differ then.
  EXPECT_LT(differenceAfter(world, 10.0), 0.2 * other);
  EXPECT_LT(differenceAfter(world, 50.0), 0.2 * other);
}

TEST(Tunnel, IsDimAndHasOncomingCars) {
  SimulationOptions options = smallOptions();
  options.rate_hz = 2.0;
  options.moving_share = 1.0;
  Simulator simulator(scenario("tunnel", 1), options);
  int with_cars = 0;
  for (int i = 0; i + 1 < simulator.size(); i += 4) {
    const SimulatedFrame frame = simulator.render(i, true);
    EXPECT_LT(cv::mean(frame.pair.left)[0], 80.0) << i;
    TruthErrors errors;
    checkTruth(simulator, i, frame, errors);
    with_cars += errors.moving > 0 ? 1 : 0;
  }
  EXPECT_GT(with_cars, 3);
}

/// Width, height and horizontal field of view.
struct Format {
  int width;
  int height;
  double view_rad;
};

StereoCamera cameraOf(const Format& format) {
  StereoCamera camera = smallOptions().camera;
  camera.width = format.width;
  camera.height = format.height;
  camera.fx = camera.fy = 0.5 * format.width / std::tan(0.5 * format.view_rad);
  camera.cx = camera.cx_right = 0.5 * (format.width - 1);
  camera.cy = 0.5 * (format.height - 1);
  return camera;
}

double correlation(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat result;
  cv::matchTemplate(a, b, result, cv::TM_CCOEFF_NORMED);
  return result.at<float>(0, 0);
}

/// A narrow small camera and a wide one, with perfect and worn rigs.
TEST(Cameras, OfAnyFieldOfViewSeeTheScenarios) {
  for (const Format& format :
       {Format{320, 240, 60.0 * kDegree}, Format{400, 250, 110.0 * kDegree}}) {
    for (const char* name : {"hall", "walk", "tunnel", "city"}) {
      SimulationOptions options;
      options.camera = cameraOf(format);
      Simulator perfect(scenario(name, 1), options);
      options.worn_rig = true;
      Simulator worn(scenario(name, 1), options);
      const int index = perfect.size() / 3;
      const SimulatedFrame sharp = perfect.render(index, true);
      const SimulatedFrame used = worn.render(index, true);
      TruthErrors errors;
      checkTruth(perfect, index, sharp, errors);
      EXPECT_GT(errors.right, 1000) << name;
      EXPECT_LT(errors.wrong, 0.02 * errors.right) << name;  // edges, and leaves in the city
      EXPECT_EQ(used.pair.left.size(), cv::Size(format.width, format.height));
      // They differ by noise, gain, vignetting, and a pixel of the calibration.
      EXPECT_GT(correlation(sharp.pair.left, used.pair.left), 0.85) << name;
      EXPECT_GT(correlation(sharp.pair.right, used.pair.right), 0.85) << name;
    }
  }
}

/// The raw images of wide lenses are not much larger than the rectified ones.
TEST(Cameras, LensesDistortTheirCornersAlike) {
  for (const double view_deg : {60.0, 81.0, 95.0, 110.0}) {
    const StereoCamera camera = cameraOf({480, 300, view_deg * kDegree});
    const WornRig rig = wornRig(camera, 1);
    const cv::Size raw = rig.left.rays().size();
    EXPECT_LT(raw.area(), 1.8 * camera.width * camera.height) << view_deg;
    EXPECT_GT(raw.area(), 0.8 * camera.width * camera.height) << view_deg;
  }
}

}  // namespace
}  // namespace rotrocc
