// Images and truth of simulated drives, at a quarter of KITTI's size.

#include <cmath>
#include <filesystem>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "rotrocc/kitti.h"
#include "simulation/drives/scenario.h"
#include "simulation/sequence_writer.h"
#include "simulation/simulator.h"
#include "simulation/truth_check.h"
#include "support/expect_error.h"
#include "support/small_camera.h"
#include "support/street_names.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr double kMaxTruthError_px = 0.01;

SimulationOptions smallOptions() {
  SimulationOptions options;
  options.camera = smallCamera();
  options.frames = 60;
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

/// Bilinear, at a place inside the image.
double greyAt(const cv::Mat& image, const Eigen::Vector2d& pixel) {
  cv::Mat patch;
  const cv::Point2f centre(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
  cv::getRectSubPix(image, {1, 1}, centre, patch, CV_32F);
  return patch.at<float>(0, 0);
}

bool isInside(const cv::Mat& image, const Eigen::Vector2d& pixel) {
  return pixel.x() >= 1.0 && pixel.y() >= 1.0 && pixel.x() < image.cols - 2 &&
         pixel.y() < image.rows - 2;
}

/// Median grey difference between the pixels of one image and their places in the other, by
/// `target`.
template <typename Target>
double medianMismatch(const cv::Mat& from, const cv::Mat& to, const Target& target) {
  std::vector<double> mismatches;
  for (int y = 2; y < from.rows - 2; ++y) {
    for (int x = 2; x < from.cols - 2; ++x) {
      const Eigen::Vector2d there = target(x, y);
      if (!isInside(to, there)) continue;
      mismatches.push_back(std::abs(greyAt(to, there) - from.at<uchar>(y, x)));
    }
  }
  std::nth_element(
      mismatches.begin(), mismatches.begin() + mismatches.size() / 2, mismatches.end());
  return mismatches[mismatches.size() / 2];
}

double medianStereoMismatch(const SimulatedFrame& frame,
                            const StereoCamera& camera,
                            double bias_px) {
  return medianMismatch(frame.pair.left, frame.pair.right, [&](int x, int y) {
    return Eigen::Vector2d(x - camera.disparity(frame.depth.at<double>(y, x)) - bias_px, y);
  });
}

TEST(Simulation, SameBytesWhateverTheThreadCount) {
  Simulator simulator(scenario("city", 3), smallOptions());
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const SimulatedFrame one = simulator.render(20, true);
  cv::setNumThreads(4);
  const SimulatedFrame four = simulator.render(20, true);
  Simulator again(scenario("city", 3), smallOptions());
  const SimulatedFrame rebuilt = again.render(20, true);
  cv::setNumThreads(threads);
  for (const SimulatedFrame& other : {four, rebuilt}) {
    EXPECT_EQ(differingPixels(one.pair.left, other.pair.left), 0);
    EXPECT_EQ(differingPixels(one.pair.right, other.pair.right), 0);
    EXPECT_EQ(differingPixels(one.depth, other.depth), 0);
  }
}

TEST(Simulation, OtherSeedsGiveOtherStreets) {
  Simulator other(scenario("city", 2), cleanOptions());
  const cv::Mat left = cleanCity().render(0, false).pair.left;
  EXPECT_GT(meanDifference(left, other.render(0, false).pair.left), 10.0);
}

TEST(Simulation, ImagesHaveTheStatisticsOfAStreet) {
  for (const std::string& name : streetNames()) {
    Simulator simulator(scenario(name, 1), smallOptions());
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(simulator.render(10, false).pair.left, mean, deviation);
    EXPECT_GT(mean[0], 70.0) << name;  // KITTI's lie between 80 and 140
    EXPECT_LT(mean[0], 150.0) << name;
    EXPECT_GT(deviation[0], 30.0) << name;
  }
}

TEST(Simulation, DepthBringsLeftOntoRight) {
  const SimulatedFrame frame = cleanCity().render(30, false);
  // The median ignores edges, where the two images differ.
  EXPECT_LT(medianStereoMismatch(frame, smallCamera(), 0.0), 1.5);
  EXPECT_GT(medianStereoMismatch(frame, smallCamera(), 2.0), 2.5);
}

TEST(Simulation, FlowBringsAnImageOntoTheNext) {
  const SimulatedFrame frame = cleanCity().render(30, true);
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

TEST(Simulation, FlowIsThatOfTheProjectedPoints) {
  Simulator& simulator = cleanCity();
  const StereoCamera camera = smallCamera();
  const SimulatedFrame frame = simulator.render(40, true);
  const Eigen::Isometry3d T_next_now = simulator.pose(41).inverse() * simulator.pose(40);
  int still = 0;
  int moving = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const double depth = frame.depth.at<double>(y, x);
      const cv::Vec2d& flow = frame.flow.at<cv::Vec2d>(y, x);
      if (std::isinf(depth) || std::isnan(flow[0])) continue;
      const Eigen::Vector2d there = camera.project(T_next_now * (depth * camera.ray({x, y})));
      const double error = (there - Eigen::Vector2d(x + flow[0], y + flow[1])).norm();
      // Only moving objects may have another flow.
      error < kMaxTruthError_px ? ++still : ++moving;
    }
  }
  EXPECT_GT(still, 20000);
  EXPECT_GT(moving, 50);
  EXPECT_LT(moving, 5000);
}

/// Disparity [px] of a place between four pixels, or NaN if they are not on one plane. On a plane
/// it is linear, so that interpolation is exact.
double disparityOfPlane(const cv::Mat& depth,
                        const StereoCamera& camera,
                        const Eigen::Vector2d& at) {
  const auto column = static_cast<int>(at.x());
  const auto row = static_cast<int>(at.y());
  const auto disparity = [&](int dx, int dy) {
    return camera.disparity(depth.at<double>(row + dy, column + dx));
  };
  const double right = disparity(1, 0) - disparity(0, 0);
  const double down = disparity(0, 1) - disparity(0, 0);
  const double bend = disparity(1, 1) - disparity(0, 0) - right - down;
  if (std::abs(bend) > 1e-3) return std::numeric_limits<double>::quiet_NaN();
  return disparity(0, 0) + (at.x() - column) * right + (at.y() - row) * down;
}

/// The depth that the next frame shows where the flow leads must be that of the moved point.
TEST(Simulation, DepthsOfTwoFramesAgree) {
  Simulator& simulator = cleanCity();
  const StereoCamera camera = smallCamera();
  const SimulatedFrame now = simulator.render(40, true);
  const SimulatedFrame next = simulator.render(41, false);
  const Eigen::Isometry3d T_next_now = simulator.pose(41).inverse() * simulator.pose(40);
  int checked = 0;
  int agreeing = 0;
  for (int y = camera.height / 2; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector3d point = T_next_now * (now.depth.at<double>(y, x) * camera.ray({x, y}));
      const Eigen::Vector2d there = camera.project(point);
      const cv::Vec2d& flow = now.flow.at<cv::Vec2d>(y, x);
      const double own_motion_px = (there - Eigen::Vector2d(x + flow[0], y + flow[1])).norm();
      if (!isInside(next.depth, there) || own_motion_px > kMaxTruthError_px) continue;
      const double seen = disparityOfPlane(next.depth, camera, there);
      const double expected = camera.disparity(point.z());
      const bool hidden = seen > expected + 0.5;  // by something nearer
      if (std::isnan(seen) || hidden) continue;
      ++checked;
      agreeing += std::abs(seen - expected) < kMaxTruthError_px ? 1 : 0;
    }
  }
  EXPECT_GT(checked, 5000);
  EXPECT_GT(agreeing, 0.95 * checked);  // the rest are edges
}

TEST(Simulation, TruthHoldsWhereTheNextFrameIsLookedAt) {
  Simulator& simulator = cleanCity();
  SimulatedFrame frame = simulator.render(40, true);
  TruthErrors errors;
  checkTruth(simulator, 40, frame, errors);
  EXPECT_GT(errors.right, 1000);
  EXPECT_LT(errors.wrong, 0.01 * errors.right);
  EXPECT_LT(errors.sum_px / errors.right, 1e-4);
  // Flow and depth that agree with each other, but not with the world.
  const StereoCamera camera = simulator.camera();
  const Eigen::Isometry3d T_next_now = simulator.pose(41).inverse() * simulator.pose(40);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      double& depth = frame.depth.at<double>(y, x);
      depth *= 1.02;
      const Eigen::Vector2d there = camera.project(T_next_now * (depth * camera.ray({x, y})));
      frame.flow.at<cv::Vec2d>(y, x) = {there.x() - x, there.y() - y};
    }
  }
  TruthErrors with_wrong_truth;
  checkTruth(simulator, 40, frame, with_wrong_truth);
  EXPECT_GT(with_wrong_truth.wrong, with_wrong_truth.right);
}

TEST(Simulation, DisparityBiasIsSeenInTheImages) {
  SimulationOptions options = cleanOptions();
  options.faults.disparity_bias_px = 1.5;
  Simulator biased(scenario("city", 1), options);
  const SimulatedFrame frame = biased.render(30, false);
  const double with_bias = medianStereoMismatch(frame, smallCamera(), 1.5);
  EXPECT_LT(with_bias, 1.5);
  EXPECT_LT(with_bias, 0.7 * medianStereoMismatch(frame, smallCamera(), 0.0));
}

TEST(Simulation, RightRotationTurnsTheRightImageOnly) {
  SimulationOptions options = cleanOptions();
  options.faults.right_rotation_rad = {0.0, 0.5 * M_PI / 180.0, 0.0};  // looks 1.57 px higher
  Simulator turned(scenario("city", 1), options);
  const SimulatedFrame frame = turned.render(30, false);
  EXPECT_EQ(differingPixels(frame.pair.left, cleanCity().render(30, false).pair.left), 0);
  const double down_px = smallCamera().fy * std::tan(0.5 * M_PI / 180.0);
  const auto mismatch = [&](double shift_px) {
    return medianMismatch(frame.pair.left, frame.pair.right, [&](int x, int y) {
      const double disparity = smallCamera().disparity(frame.depth.at<double>(y, x));
      return Eigen::Vector2d(x - disparity, y + shift_px);
    });
  };
  EXPECT_LT(mismatch(down_px), 0.8 * mismatch(0.0));
  EXPECT_LT(mismatch(down_px), 0.8 * mismatch(-down_px));
}

TEST(Simulation, RowOffsetLowersTheRightImageOnly) {
  SimulationOptions options = cleanOptions();
  options.faults.row_offset_px = 2.0;
  Simulator offset(scenario("city", 1), options);
  const SimulatedFrame frame = offset.render(30, false);
  const SimulatedFrame aligned = cleanCity().render(30, false);
  EXPECT_EQ(differingPixels(frame.pair.left, aligned.pair.left), 0);
  const int rows = frame.pair.right.rows;
  const cv::Mat lowered = frame.pair.right.rowRange(2, rows);
  // Rays that differ by rounding may end on the other side of an edge.
  EXPECT_LT(differingPixels(lowered, aligned.pair.right.rowRange(0, rows - 2)),
            0.02 * lowered.total());
}

TEST(Simulation, TimeSkewShowsTheRightImageLater) {
  SimulationOptions options = cleanOptions();
  options.faults.time_skew_s = 0.1;
  Simulator skewed(scenario("city", 1), options);
  const SimulatedFrame frame = skewed.render(30, false);
  EXPECT_EQ(differingPixels(frame.pair.left, cleanCity().render(30, false).pair.left), 0);
  EXPECT_EQ(differingPixels(frame.pair.right, cleanCity().render(31, false).pair.right), 0);
}

TEST(Simulation, DroppedFramesLeaveGapsInTime) {
  SimulationOptions options = cleanOptions();
  options.frames = 0;
  options.drop_share = 0.25;
  Simulator gappy(scenario("parking", 1), options);
  options.drop_share = 0.0;
  Simulator whole(scenario("parking", 1), options);
  EXPECT_EQ(gappy.stamp_ns(0), 0);
  EXPECT_NEAR(gappy.size(), 0.75 * whole.size(), 0.08 * whole.size());
  const int last = gappy.size() - 1;
  const int same = static_cast<int>(gappy.stamp_ns(last) / 100'000'000);
  EXPECT_EQ(gappy.stamp_ns(last), whole.stamp_ns(same));
  EXPECT_TRUE(gappy.pose(last).isApprox(whole.pose(same), 1e-12));
}

TEST(Simulation, NoiseHasItsSigma) {
  SimulationOptions options = cleanOptions();
  options.faults.sensor.noise_sigma = 3.0;
  Simulator noisy(scenario("city", 1), options);
  cv::Mat difference;
  cv::subtract(noisy.render(5, false).pair.left,
               cleanCity().render(5, false).pair.left,
               difference,
               cv::noArray(),
               CV_32F);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(difference(cv::Rect(0, 50, 310, 44)), mean, deviation);  // not the saturated sky
  EXPECT_NEAR(mean[0], 0.0, 0.1);
  EXPECT_NEAR(deviation[0], 3.0, 0.15);
}

TEST(Simulation, NoiseSeedChangesTheNoiseOnly) {
  SimulationOptions options = cleanOptions();
  options.noise_seed = 2;
  Simulator clean(scenario("city", 1), options);
  EXPECT_EQ(
      differingPixels(clean.render(5, false).pair.left, cleanCity().render(5, false).pair.left), 0);
  options.faults.sensor.noise_sigma = 3.0;
  const cv::Mat one = Simulator(scenario("city", 1), options).render(5, false).pair.left;
  options.noise_seed = 3;
  const cv::Mat other = Simulator(scenario("city", 1), options).render(5, false).pair.left;
  // Two draws of 3 grey levels differ by 3.4 in the mean; where the sky is white, both are
  // saturated.
  EXPECT_GT(meanDifference(one, other), 1.0);
}

TEST(Simulation, VignettingDarkensTheCorners) {
  SimulationOptions options = cleanOptions();
  options.faults.sensor.vignetting = 0.5;
  Simulator dark(scenario("city", 1), options);
  const cv::Mat with = dark.render(5, false).pair.left;
  const cv::Mat without = cleanCity().render(5, false).pair.left;
  const cv::Rect corner(0, 74, 20, 20);
  const cv::Rect centre(145, 40, 20, 14);
  EXPECT_LT(cv::mean(with(corner))[0], 0.75 * cv::mean(without(corner))[0]);
  EXPECT_NEAR(cv::mean(with(centre))[0], cv::mean(without(centre))[0], 1.0);
}

TEST(Simulation, ExposureJumpsChangeTheBrightnessOfBothImages) {
  SimulationOptions options = cleanOptions();
  options.faults.exposure_jumps = 0.6;
  Simulator jumping(scenario("city", 1), options);
  double most = 0.0;
  for (const int frame : {2, 14, 26, 38}) {
    const SimulatedFrame with = jumping.render(frame, false);
    const SimulatedFrame without = cleanCity().render(frame, false);
    const double left = cv::mean(with.pair.left)[0] / cv::mean(without.pair.left)[0];
    const double right = cv::mean(with.pair.right)[0] / cv::mean(without.pair.right)[0];
    EXPECT_NEAR(left, right, 0.02);
    most = std::max(most, std::abs(std::log(left)));
  }
  EXPECT_GT(most, 0.1);
}

TEST(Simulation, MotionBlurSoftensWhatMoves) {
  SimulationOptions options = cleanOptions();
  options.faults.motion_blur_s = 0.04;
  Simulator blurred(scenario("city", 1), options);
  const auto detail = [](const cv::Mat& image) {
    cv::Mat slopes;
    cv::Sobel(image, slopes, CV_32F, 1, 0);
    return cv::norm(slopes, cv::NORM_L1) / static_cast<double>(image.total());
  };
  const double sharp = detail(cleanCity().render(50, false).pair.left);
  EXPECT_LT(detail(blurred.render(50, false).pair.left), 0.95 * sharp);
  const double at_rest = detail(cleanCity().render(0, false).pair.left);
  EXPECT_GT(detail(blurred.render(0, false).pair.left), 0.98 * at_rest);
}

TEST(Simulation, WritesSequencesThatCanBeReadBack) {
  const TemporaryDirectory directory;
  SimulationOptions options = cleanOptions();
  options.frames = 3;
  options.rate_hz = 0.5;  // far apart, so that flow and poses are
  Simulator simulator(scenario("city", 1), options);
  SequenceWriter writer(directory / "drive", simulator, true);
  const SimulatedFrame frame = simulator.render(1, true);
  for (const int i : {0, 1, 2}) writer.write(simulator.render(i, true));

  const KittiSequence sequence(directory / "drive");
  ASSERT_EQ(sequence.size(), 3);
  EXPECT_EQ(sequence.camera(), simulator.camera());
  EXPECT_EQ(sequence.stamp_ns(2), simulator.stamp_ns(2));
  EXPECT_TRUE(sequence.groundTruth()[1].T_world_body.isApprox(simulator.pose(1), 1e-6));
  EXPECT_EQ(differingPixels(sequence.readRight(1), frame.pair.right), 0);

  const cv::Mat depth = cv::imread(directory / "drive/depth/000001.tiff", cv::IMREAD_UNCHANGED);
  ASSERT_EQ(depth.type(), CV_32FC1);
  EXPECT_NEAR(depth.at<float>(80, 100), frame.depth.at<double>(80, 100), 1e-5);
  EXPECT_EQ(cv::countNonZero(depth == 0.0F), cv::countNonZero(frame.depth > 1e30));
  const cv::Mat flow = cv::imread(directory / "drive/flow/000001.png", cv::IMREAD_UNCHANGED);
  ASSERT_EQ(flow.type(), CV_16UC3);
  const cv::Vec3w code = flow.at<cv::Vec3w>(60, 100);
  EXPECT_EQ(code[0], 1);
  EXPECT_NEAR((code[2] - 32768) / 64.0, frame.flow.at<cv::Vec2d>(60, 100)[0], 0.008);
  EXPECT_NEAR((code[1] - 32768) / 64.0, frame.flow.at<cv::Vec2d>(60, 100)[1], 0.008);

  expectError<std::runtime_error>(
      [&] { SequenceWriter again(directory / "drive", simulator, false); }, "not empty");
}

TEST(Simulation, SequencesCanBeReadWhileTheyAreWritten) {
  const TemporaryDirectory directory;
  SimulationOptions options = smallOptions();
  options.frames = 2;
  Simulator simulator(scenario("parking", 1), options);
  SequenceWriter writer(directory / "drive", simulator, false);
  writer.write(simulator.render(0, false));
  expectError<std::runtime_error>([&] { KittiSequence(directory / "drive"); },
                                  "has 1 entries, but times.txt has 2 times");
  const KittiSequence sequence(directory / "drive", true);
  EXPECT_EQ(sequence.size(), 2);
  EXPECT_EQ(sequence.groundTruth().size(), 2U);
  EXPECT_TRUE(sequence.hasPair(0));
  EXPECT_FALSE(sequence.hasPair(1));
  const SimulatedFrame frame = simulator.render(1, false);
  writer.write(frame);
  EXPECT_TRUE(sequence.hasPair(1));
  EXPECT_EQ(differingPixels(sequence.readRight(1), frame.pair.right), 0);
}

TEST(Simulation, RefusesOptionsOutOfRange) {
  const auto expectRefused = [](const SimulationOptions& options, const std::string& part) {
    expectError<std::invalid_argument>(
        [&] { Simulator simulator(scenario("parking", 1), options); }, part);
  };
  SimulationOptions options;
  options.moving_share = 1.5;
  expectRefused(options, "share of moving cars is 1.5");
  options = {};
  options.faults.sensor.noise_sigma = -1.0;
  expectRefused(options, "noise [grey levels] is -1");
  options = {};
  options.camera.baseline_m = 0.0;
  expectRefused(options, "baseline");
}

}  // namespace
}  // namespace rotrocc
