// Images and truth of simulated drives, and the odometry on each scenario.

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>

#include "rotrocc/rigid_motion.h"
#include "rotrocc/visual_odometry.h"
#include "sequences/stereo_sequence.h"
#include "simulation/sequence_writer.h"
#include "simulation/simulator.h"
#include "support/expect_error.h"
#include "support/slow_build.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

StereoCamera smallCamera() {
  StereoCamera camera = kittiCamera();
  camera.width = 310;
  camera.height = 94;
  camera.fx = camera.fy = 180.0;
  camera.cx = camera.cx_right = 152.0;
  camera.cy = 46.0;
  return camera;
}

SimulationOptions cleanOptions() {
  SimulationOptions options;
  options.camera = smallCamera();
  options.moving_share = 0.0;
  options.faults.noise_sigma = 0.0;
  return options;
}

int differingPixels(const cv::Mat& a, const cv::Mat& b) {
  return cv::countNonZero(a != b);
}

bool isInside(const cv::Mat& image, const Eigen::Vector2d& pixel) {
  return pixel.x() >= 1.0 && pixel.y() >= 1.0 && pixel.x() < image.cols - 2 &&
         pixel.y() < image.rows - 2;
}

/// Disparity [px] of a place between four pixels, or NaN if they are not on one plane. On a plane
/// it is linear, so that interpolation is exact.
double disparityOfPlane(const cv::Mat& depth, const Eigen::Vector2d& at) {
  const auto column = static_cast<int>(at.x());
  const auto row = static_cast<int>(at.y());
  const auto disparity = [&](int dx, int dy) {
    return smallCamera().disparity(depth.at<double>(row + dy, column + dx));
  };
  const double right = disparity(1, 0) - disparity(0, 0);
  const double down = disparity(0, 1) - disparity(0, 0);
  const double bend = disparity(1, 1) - disparity(0, 0) - right - down;
  if (std::abs(bend) > 1e-3) return std::numeric_limits<double>::quiet_NaN();
  return disparity(0, 0) + (at.x() - column) * right + (at.y() - row) * down;
}

class ScenarioTest : public ::testing::TestWithParam<std::string> {};

/// What stands has, in the next frame, the depth that the poses give it there.
TEST_P(ScenarioTest, PosesAndDepthAreExact) {
  constexpr double kMaxError_px = 0.01;
  const Simulator simulator(scenario(GetParam(), 1), cleanOptions());
  const StereoCamera camera = smallCamera();
  const int index = simulator.size() / 3;
  const SimulatedFrame now = simulator.render(index);
  const SimulatedFrame next = simulator.render(index + 1);
  const Eigen::Isometry3d T_next_now = simulator.pose(index + 1).inverse() * simulator.pose(index);
  int checked = 0, agreeing = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const double depth = now.depth.at<double>(y, x);
      if (std::isinf(depth)) continue;
      const Eigen::Vector3d point = T_next_now * (depth * camera.ray({x, y}));
      const Eigen::Vector2d there = camera.project(point);
      if (point.z() <= 0.0 || !isInside(next.depth, there)) continue;
      const double seen = disparityOfPlane(next.depth, there);
      const double expected = camera.disparity(point.z());
      const bool hidden = seen > expected + 0.5;  // by something nearer
      if (std::isnan(seen) || hidden) continue;
      ++checked;
      agreeing += std::abs(seen - expected) < kMaxError_px ? 1 : 0;
    }
  }
  EXPECT_GT(checked, 5000);
  EXPECT_GT(agreeing, 0.93 * checked);  // the rest are edges and leaves
}

TEST_P(ScenarioTest, SameSeedSameBytesWhateverTheThreadCount) {
  SimulationOptions options;
  options.camera = smallCamera();
  const auto frame = [&](std::uint64_t seed, std::uint64_t noise_seed, int threads) {
    cv::setNumThreads(threads);
    options.seed = seed;
    options.noise_seed = noise_seed;
    const Simulator simulator(scenario(GetParam(), seed), options);
    return simulator.render(simulator.size() / 2);
  };
  const int threads = cv::getNumThreads();
  const SimulatedFrame one = frame(1, 1, 1), four = frame(1, 1, 4), other = frame(2, 1, 4);
  const SimulatedFrame noise = frame(1, 2, 4);
  cv::setNumThreads(threads);
  EXPECT_EQ(differingPixels(one.pair.left, four.pair.left), 0);
  EXPECT_EQ(differingPixels(one.pair.right, four.pair.right), 0);
  EXPECT_EQ(differingPixels(one.depth, four.depth), 0);
  EXPECT_GT(differingPixels(one.depth, other.depth), 1000);
  EXPECT_EQ(differingPixels(one.depth, noise.depth), 0);
  const auto pixels = static_cast<double>(one.pair.left.total());
  // The mean size of the difference of two noises of 2 gray levels.
  EXPECT_NEAR(
      cv::norm(one.pair.left, noise.pair.left, cv::NORM_L1) / pixels, 4.0 / std::sqrt(M_PI), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Scenarios,
                         ScenarioTest,
                         ::testing::Values("city", "motorway"),
                         [](const auto& name) { return name.param; });

/// In fast turns, a third of the features may agree on a motion that others contradict.
TEST(HandheldTest, AnAgreementOfFewIsNotTheMotion) {
  SimulationOptions options;
  options.rate_hz = 20.0;
  const StereoCamera kitti = kittiCamera();
  StereoCamera& camera = options.camera;
  camera.width = 752;
  camera.height = 480;
  camera.fx = camera.fy = 458.0;
  camera.cx = camera.cx_right = (kitti.cx + 0.5) * camera.width / kitti.width - 0.5;
  camera.cy = (kitti.cy + 0.5) * camera.height / kitti.height - 0.5;
  camera.baseline_m = 0.12;
  const Simulator simulator(scenario("handheld", 1), options);
  VisualOdometry odometry{VisualOdometry::Config{}};
  constexpr int kFirst = 80, kLast = 88, kStep = 2;  // 10 Hz: 100 deg/s
  for (int i = kFirst; i <= kLast; i += kStep) {
    const OdometryResult result = odometry.process(simulator.render(i).pair, camera);
    if (i == kFirst) continue;
    const Eigen::Isometry3d T_prev_cur = simulator.pose(i - kStep).inverse() * simulator.pose(i);
    const double step_m = T_prev_cur.translation().norm();
    EXPECT_LT((result.T_prev_cur.translation() - T_prev_cur.translation()).norm(), 0.05 * step_m)
        << i << ": " << result.reason;
  }
}

class ScenarioAccuracyTest : public ::testing::TestWithParam<std::string> {};

/// In the middle of a scenario, where the car drives.
TEST_P(ScenarioAccuracyTest, FollowsTheDriveWithoutABias) {
  SimulationOptions options;
  if (GetParam() == "handheld") options.rate_hz = 20.0;  // 10 Hz needs a gyroscope
  const Simulator simulator(scenario(GetParam(), 1), options);
  VisualOdometry odometry{VisualOdometry::Config{}};
  std::vector<double> errors;
  const int first = simulator.size() / 4;
  const int pairs = isSlowBuild() ? 5 : 13;
  for (int i = first; i < first + pairs; ++i) {
    const OdometryResult result = odometry.process(simulator.render(i).pair, simulator.camera());
    if (i == first) continue;
    ASSERT_TRUE(result.hasMotion()) << result.reason;
    const Eigen::Isometry3d T_prev_cur = simulator.pose(i - 1).inverse() * simulator.pose(i);
    const double length_m = T_prev_cur.translation().norm();
    ASSERT_GT(length_m, 0.0);
    errors.push_back(result.T_prev_cur.translation().norm() / length_m - 1.0);
    const Eigen::AngleAxisd turn_error(T_prev_cur.linear().transpose() *
                                       result.T_prev_cur.linear());
    // Far more than the error of the mean of hundreds of features.
    EXPECT_LT(turn_error.angle(), 0.15 / kittiCamera().fx);
  }

  double mean = 0.0;
  double squares = 0.0;
  for (const double error : errors) {
    mean += error / static_cast<double>(errors.size());
    squares += error * error;
  }
  // The bias over a whole drive must be less than 0.3 %; this short part of it has a mean that is
  // uncertain by its steps' errors.
  const double uncertainty = std::sqrt(squares) / static_cast<double>(errors.size());
  EXPECT_LT(std::abs(mean), 0.003 + 3.0 * uncertainty);
  EXPECT_LT(uncertainty, 0.003);
}

INSTANTIATE_TEST_SUITE_P(Scenarios,
                         ScenarioAccuracyTest,
                         ::testing::Values("city", "motorway", "slip_road", "parking", "handheld"),
                         [](const auto& name) { return name.param; });

TEST(Simulation, WritesSequencesThatCanBeReadMeanwhile) {
  const TemporaryDirectory directory;
  SimulationOptions options = cleanOptions();
  options.frames = 2;
  options.rate_hz = 0.5;  // far apart, so that poses are
  const Simulator simulator(scenario("city", 1), options);
  SequenceWriter writer(directory / "drive", simulator, {true, false});
  const SimulatedFrame frame = simulator.render(0);
  writer.write(frame);
  EXPECT_EQ(openStereoSequence(directory / "drive", {}).size(), 1);
  SequenceOptions options_of_reader;
  options_of_reader.being_written = true;
  const StereoSequence sequence = openStereoSequence(directory / "drive", options_of_reader);
  EXPECT_FALSE(sequence.pairs.hasFiles(1));
  writer.write(simulator.render(1));
  EXPECT_TRUE(sequence.pairs.hasFiles(1));
  EXPECT_EQ(sequence.size(), 2);
  EXPECT_EQ(sequence.calibration.rectified.differenceTo(simulator.camera()), 0.0);
  EXPECT_EQ(sequence.stamp_ns(1), simulator.stamp_ns(1));
  EXPECT_TRUE(sequence.ground_truth[1].T_world_body.isApprox(simulator.pose(1), 1e-6));
  EXPECT_EQ(differingPixels(sequence.read(0).right, frame.pair.right), 0);

  const cv::Mat depth = cv::imread(directory / "drive/depth/000000.tiff", cv::IMREAD_UNCHANGED);
  ASSERT_EQ(depth.type(), CV_32FC1);
  EXPECT_NEAR(depth.at<float>(80, 100), frame.depth.at<double>(80, 100), 1e-5);
  EXPECT_EQ(cv::countNonZero(depth == 0.0F), cv::countNonZero(frame.depth > 1e30));
  expectError<std::runtime_error>([&] { SequenceWriter again(directory / "drive", simulator, {}); },
                                  "not empty");
}

/// The mean difference to the true turn rate is the bias.
TEST(Simulation, GyroscopeTurnsAsTheFramesDo) {
  const Scenario handheld = scenario("handheld", 1);
  const std::vector<GyroSample> samples = Simulator(handheld, cleanOptions()).gyroscope();
  EXPECT_GT(samples.size(), 7000u);  // 40 s at 200 Hz
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const GyroSample& sample : samples) {
    const double time_s = 1e-9 * static_cast<double>(sample.stamp_ns);
    const Eigen::Matrix3d R_before = handheld.drive->pose(time_s - 0.002).linear();
    const Eigen::Matrix3d R_after = handheld.drive->pose(time_s + 0.002).linear();
    const Eigen::Vector3d error =
        sample.rate_rps - logRotation(R_before.transpose() * R_after) / 0.004;
    EXPECT_LT(error.norm(), 0.1) << time_s;  // the camera turns with up to 2 rad/s
    sum += error;
  }
  EXPECT_GT(sum.norm() / static_cast<double>(samples.size()), 1e-3);
}

}  // namespace
}  // namespace rotrocc
