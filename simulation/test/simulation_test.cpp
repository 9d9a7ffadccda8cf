// Images and truth of simulated drives, at a quarter of KITTI's size.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "rotrocc/kitti.h"
#include "rotrocc/rigid_motion.h"
#include "simulation/drives/scenario.h"
#include "simulation/sequence_writer.h"
#include "simulation/simulator.h"
#include "support/expect_error.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

/// KITTI's grey cameras at a quarter of their size.
StereoCamera smallCamera() {
  StereoCamera camera;
  camera.width = 310;
  camera.height = 94;
  camera.fx = camera.fy = 180.0;
  camera.cx = camera.cx_right = 152.0;
  camera.cy = 46.0;
  camera.baseline_m = 0.537;
  return camera;
}

SimulationOptions smallOptions() {
  SimulationOptions options;
  options.camera = smallCamera();
  options.moving_share = 1.0;
  return options;
}

SimulationOptions cleanOptions() {
  SimulationOptions options = smallOptions();
  options.faults.sensor.noise_sigma = 0.0;
  options.faults.sensor.vignetting = 0.0;
  return options;
}

/// Building a world takes a second: those of the tests are built once.
Simulator& cleanCity() {
  static Simulator simulator(scenario("city", 1), cleanOptions());
  return simulator;
}

int differingPixels(const cv::Mat& a, const cv::Mat& b) {
  return cv::countNonZero(a != b);
}

double meanDifference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total());
}

/// Mean size of the slopes: how much texture there is.
double textureOf(const cv::Mat& image) {
  cv::Mat slopes;
  cv::Sobel(image, slopes, CV_32F, 1, 0);
  return cv::norm(slopes, cv::NORM_L1) / static_cast<double>(image.total());
}

bool isInside(const cv::Mat& image, const Eigen::Vector2d& pixel) {
  return pixel.x() >= 1.0 && pixel.y() >= 1.0 && pixel.x() < image.cols - 2 &&
         pixel.y() < image.rows - 2;
}

/// Median grey difference between the pixels of one image and their places in the other, by
/// `target`. It ignores edges, where the two images differ.
template <typename Target>
double medianMismatch(const cv::Mat& from, const cv::Mat& to, const Target& target) {
  std::vector<double> mismatches;
  for (int y = 2; y < from.rows - 2; ++y) {
    for (int x = 2; x < from.cols - 2; ++x) {
      const Eigen::Vector2d there = target(x, y);
      if (!isInside(to, there)) continue;
      cv::Mat grey;
      const cv::Point2f centre(static_cast<float>(there.x()), static_cast<float>(there.y()));
      cv::getRectSubPix(to, {1, 1}, centre, grey, CV_32F);
      mismatches.push_back(std::abs(grey.at<float>(0, 0) - from.at<uchar>(y, x)));
    }
  }
  const auto middle = mismatches.begin() + mismatches.size() / 2;
  std::nth_element(mismatches.begin(), middle, mismatches.end());
  return *middle;
}

/// With the right image `bias_px` farther to the left and `lower_px` lower than it should be.
double stereoMismatch(const SimulatedFrame& frame, double bias_px, double lower_px = 0.0) {
  return medianMismatch(frame.pair.left, frame.pair.right, [&](int x, int y) {
    const double disparity = smallCamera().disparity(frame.depth.at<double>(y, x));
    return Eigen::Vector2d(x - disparity - bias_px, y + lower_px);
  });
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

/// What stands moves by the poses, and the next frame has the moved point's depth there.
TEST_P(ScenarioTest, PosesDepthAndFlowAreExact) {
  constexpr double kMaxError_px = 0.01;
  Simulator simulator(scenario(GetParam(), 1), smallOptions());
  const StereoCamera camera = smallCamera();
  const int index = simulator.size() / 3;
  const SimulatedFrame now = simulator.render(index, true);
  const SimulatedFrame next = simulator.render(index + 1, true);
  const Eigen::Isometry3d T_next_now = simulator.pose(index + 1).inverse() * simulator.pose(index);
  int still = 0, moving = 0, checked = 0, agreeing = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const double depth = now.depth.at<double>(y, x);
      const cv::Vec2d& flow = now.flow.at<cv::Vec2d>(y, x);
      if (std::isinf(depth) || std::isnan(flow[0])) continue;
      const Eigen::Vector3d point = T_next_now * (depth * camera.ray({x, y}));
      const Eigen::Vector2d there = camera.project(point);
      const bool moves = (there - Eigen::Vector2d(x + flow[0], y + flow[1])).norm() > kMaxError_px;
      ++(moves ? moving : still);
      if (moves || !isInside(next.depth, there)) continue;
      const double seen = disparityOfPlane(next.depth, there);
      const double expected = camera.disparity(point.z());
      const bool hidden = seen > expected + 0.5;  // by something nearer
      if (std::isnan(seen) || hidden) continue;
      ++checked;
      agreeing += std::abs(seen - expected) < kMaxError_px ? 1 : 0;
    }
  }
  EXPECT_GT(still, 10000);
  EXPECT_LT(moving, 0.3 * still);
  EXPECT_GT(checked, 5000);
  EXPECT_GT(agreeing, 0.93 * checked);  // the rest are edges and leaves
}

TEST_P(ScenarioTest, SameSeedSameBytesWhateverTheThreadCount) {
  for (const bool worn : {false, true}) {
    SimulationOptions options = smallOptions();
    options.worn_rig = worn;
    const auto frame = [&](std::uint64_t seed, int threads) {
      cv::setNumThreads(threads);
      options.seed = seed;
      Simulator simulator(scenario(GetParam(), seed), options);
      return simulator.render(simulator.size() / 2, true);
    };
    const int threads = cv::getNumThreads();
    const SimulatedFrame one = frame(1, 1), four = frame(1, 4), other = frame(2, 4);
    cv::setNumThreads(threads);
    EXPECT_EQ(differingPixels(one.pair.left, four.pair.left), 0) << worn;
    EXPECT_EQ(differingPixels(one.pair.right, four.pair.right), 0) << worn;
    EXPECT_EQ(differingPixels(one.depth, four.depth), 0) << worn;
    EXPECT_GT(meanDifference(one.pair.left, other.pair.left), 5.0) << worn;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenarios,
                         ScenarioTest,
                         ::testing::Values("city", "motorway", "night", "hall"),
                         [](const auto& name) { return name.param; });

TEST(Simulation, DepthAndFlowBringImagesOntoEachOther) {
  const SimulatedFrame frame = cleanCity().render(30, true);
  EXPECT_LT(stereoMismatch(frame, 0.0), 1.5);
  EXPECT_GT(stereoMismatch(frame, 2.0), 2.5);
  const SimulatedFrame next = cleanCity().render(31, false);
  const auto mismatch = [&](double error_px) {
    return medianMismatch(frame.pair.left, next.pair.left, [&](int x, int y) {
      const cv::Vec2d& flow = frame.flow.at<cv::Vec2d>(y, x);
      return Eigen::Vector2d(x + flow[0] + error_px, y + flow[1]);
    });
  };
  EXPECT_LT(mismatch(0.0), 1.5);
  EXPECT_GT(mismatch(2.0), 2.5);
}

TEST(Simulation, FaultsAreSeenInTheRightImageOnly) {
  const SimulatedFrame good = cleanCity().render(30, false);
  const auto frameWith = [&](const CameraFaults& faults) {
    SimulationOptions options = cleanOptions();
    options.faults = faults;
    options.faults.sensor = cleanOptions().faults.sensor;
    const SimulatedFrame frame = Simulator(scenario("city", 1), options).render(30, false);
    EXPECT_EQ(differingPixels(frame.pair.left, good.pair.left), 0);
    return frame;
  };
  CameraFaults faults;
  faults.disparity_bias_px = 1.5;
  const SimulatedFrame biased = frameWith(faults);
  EXPECT_LT(stereoMismatch(biased, 1.5), 1.5);
  EXPECT_LT(stereoMismatch(biased, 1.5), 0.7 * stereoMismatch(biased, 0.0));

  faults = {};
  faults.right_rotation_rad.y() = 0.5 * M_PI / 180.0;  // looks higher
  const SimulatedFrame turned = frameWith(faults);
  const double lower_px = smallCamera().fy * std::tan(0.5 * M_PI / 180.0);
  EXPECT_LT(stereoMismatch(turned, 0.0, lower_px), 0.8 * stereoMismatch(turned, 0.0));
  EXPECT_LT(stereoMismatch(turned, 0.0, lower_px), 0.8 * stereoMismatch(turned, 0.0, -lower_px));

  faults = {};
  faults.row_offset_px = 2.0;
  const cv::Mat offset = frameWith(faults).pair.right;
  const int rows = offset.rows;
  // Rays that differ by rounding may end on the other side of an edge.
  EXPECT_LT(differingPixels(offset.rowRange(2, rows), good.pair.right.rowRange(0, rows - 2)),
            0.02 * offset.total());

  faults = {};
  faults.time_skew_s = 0.1;
  EXPECT_EQ(differingPixels(frameWith(faults).pair.right, cleanCity().render(31, false).pair.right),
            0);
}

TEST(Simulation, NoiseIsOfItsSeed) {
  SimulationOptions options = smallOptions();
  const cv::Mat noisy = Simulator(scenario("city", 1), options).render(5, false).pair.left;
  options.noise_seed = 2;
  const cv::Mat other = Simulator(scenario("city", 1), options).render(5, false).pair.left;
  EXPECT_NEAR(meanDifference(noisy, other), 2.0, 1.0);
}

TEST(Simulation, MotionBlurSoftensWhatMoves) {
  SimulationOptions options = cleanOptions();
  options.faults.motion_blur_s = 0.04;
  Simulator blurred(scenario("city", 1), options);
  const double sharp = textureOf(cleanCity().render(50, false).pair.left);
  EXPECT_LT(textureOf(blurred.render(50, false).pair.left), 0.95 * sharp);
  const double at_rest = textureOf(cleanCity().render(0, false).pair.left);
  EXPECT_GT(textureOf(blurred.render(0, false).pair.left), 0.98 * at_rest);
}

/// Along recorded poses that come back to a street 6 m lower, as those of KITTI 08 do.
TEST(Simulation, RecordedPosesAreKeptAboveTheGround) {
  Trajectory trajectory;
  for (int i = 0; i <= 250; ++i) {
    const double angle = 2.0 * M_PI * i / 200.0;  // 1 1/4 rounds
    StampedPose pose;
    pose.stamp_ns = i * 100'000'000LL;
    pose.T_world_body.translation() << 40.0 - 40.0 * std::cos(angle), 6.0 * i / 200.0,
        40.0 * std::sin(angle);
    pose.T_world_body.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()));
    trajectory.push_back(pose);
  }
  const Simulator simulator(scenarioAlong(trajectory, 1), SimulationOptions{});
  const Eigen::Isometry3d T_first_world = trajectory.front().T_world_body.inverse();
  for (int i = 0; i <= 250; ++i) {
    EXPECT_EQ(simulator.stamp_ns(i), trajectory[i].stamp_ns);
    EXPECT_TRUE(simulator.pose(i).isApprox(T_first_world * trajectory[i].T_world_body, 1e-9)) << i;
    const Eigen::Vector3d at = trajectory[i].T_world_body.translation();
    EXPECT_GT(simulator.world().terrain().height(at.x(), at.z()) - at.y(), 0.3) << i;
  }
}

TEST(Simulation, WritesSequencesThatCanBeReadMeanwhile) {
  const TemporaryDirectory directory;
  SimulationOptions options = cleanOptions();
  options.frames = 2;
  options.rate_hz = 0.5;  // far apart, so that flow and poses are
  Simulator simulator(scenario("city", 1), options);
  SequenceWriter writer(directory / "drive", simulator, true);
  const SimulatedFrame frame = simulator.render(0, true);
  writer.write(frame);
  expectError<std::runtime_error>([&] { KittiSequence(directory / "drive"); },
                                  "has 1 entries, but times.txt has 2 times");
  const KittiSequence sequence(directory / "drive", true);
  EXPECT_FALSE(std::filesystem::exists(sequence.rightPath(1)));
  writer.write(simulator.render(1, true));
  EXPECT_TRUE(std::filesystem::exists(sequence.rightPath(1)));
  EXPECT_EQ(sequence.size(), 2);
  EXPECT_EQ(sequence.camera(), simulator.camera());
  EXPECT_EQ(sequence.stamp_ns(1), simulator.stamp_ns(1));
  EXPECT_TRUE(sequence.groundTruth()[1].T_world_body.isApprox(simulator.pose(1), 1e-6));
  EXPECT_EQ(differingPixels(sequence.readRight(0), frame.pair.right), 0);

  const cv::Mat depth = cv::imread(directory / "drive/depth/000000.tiff", cv::IMREAD_UNCHANGED);
  ASSERT_EQ(depth.type(), CV_32FC1);
  EXPECT_NEAR(depth.at<float>(80, 100), frame.depth.at<double>(80, 100), 1e-5);
  EXPECT_EQ(cv::countNonZero(depth == 0.0F), cv::countNonZero(frame.depth > 1e30));
  const cv::Mat flow = cv::imread(directory / "drive/flow/000000.png", cv::IMREAD_UNCHANGED);
  ASSERT_EQ(flow.type(), CV_16UC3);
  const cv::Vec3w code = flow.at<cv::Vec3w>(60, 100);
  EXPECT_EQ(code[0], 1);
  EXPECT_NEAR((code[2] - 32768) / 64.0, frame.flow.at<cv::Vec2d>(60, 100)[0], 0.008);
  EXPECT_NEAR((code[1] - 32768) / 64.0, frame.flow.at<cv::Vec2d>(60, 100)[1], 0.008);
  expectError<std::runtime_error>(
      [&] { SequenceWriter again(directory / "drive", simulator, false); }, "not empty");
}

/// The mean difference to the true turn rate is the bias.
TEST(Simulation, GyroscopeTurnsAsTheFramesDo) {
  const Scenario handheld = scenario("handheld", 1);
  const std::vector<GyroSample> samples = Simulator(handheld, smallOptions()).gyroscope();
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

SimulationOptions withLorry(double across_mps) {
  SimulationOptions options = cleanOptions();
  options.moving_share = 0.0;
  options.lorry = {0.5, across_mps};
  return options;
}

TEST(Lorry, CoversItsShareAndMovesWithTheCamera) {
  Simulator simulator(scenario("city", 1), withLorry(0.0));
  const SimulatedFrame frame = simulator.render(50, true);
  const cv::Mat near = (frame.depth > 4.0) & (frame.depth < 6.0);
  EXPECT_NEAR(cv::countNonZero(near) / static_cast<double>(near.total()), 0.5, 0.1);
  // It keeps its place in the image but for the pitch of the camera; the road does not.
  EXPECT_LT(cv::norm(frame.flow.at<cv::Vec2d>(near.rows / 2, near.cols / 4)), 1.0);
  EXPECT_GT(cv::norm(frame.flow.at<cv::Vec2d>(near.rows - 10, 3 * near.cols / 4)), 5.0);
}

TEST(Lorry, ChangesLanes) {
  const SimulationOptions options = withLorry(1.0);
  const Scenario city = scenario("city", 1);
  Simulator simulator(city, options);
  const int middle = static_cast<int>(0.5 * city.drive->duration_s() * options.rate_hz);
  const SimulatedFrame frame = simulator.render(middle, true);
  const cv::Vec2d flow = frame.flow.at<cv::Vec2d>(frame.depth.rows / 2, 2);
  EXPECT_NEAR(flow[0], options.camera.fx / options.rate_hz / 5.0, 0.1);  // 5 m ahead
}

/// Three brightnesses, in light and in shade: the road has more of its own.
TEST(RepeatedTexture, IsAllThatIsLeft) {
  SimulationOptions options = cleanOptions();
  options.tiled_share = 1.0;
  const cv::Mat tiled = Simulator(scenario("city", 1), options).render(50, false).pair.left;
  const cv::Mat street = cleanCity().render(50, false).pair.left;
  EXPECT_GT(differingPixels(tiled, street), 0.4 * static_cast<double>(street.total()));
  EXPECT_GT(textureOf(tiled), textureOf(street));
}

}  // namespace
}  // namespace rotrocc
