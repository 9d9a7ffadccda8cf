// A rendered drive with a bumper in view, which moves with the camera, with and without a mask.

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "rotrocc/kitti.h"
#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr int kPairs = 10;
constexpr int kDisparity_px = 30;  // of what is as near as a bumper

/// The same pixels in the lowest fifth of all images of a camera.
void coverByBumper(const std::string& drive) {
  const cv::Mat first = cv::imread(drive + "/image_0/000000.png", cv::IMREAD_GRAYSCALE);
  const cv::Rect covered(0, first.rows - first.rows / 5, first.cols, first.rows / 5);
  cv::Mat bumper(covered.height, covered.width + kDisparity_px, CV_8UC1);
  cv::RNG(1).fill(bumper, cv::RNG::UNIFORM, 0, 255);
  cv::GaussianBlur(bumper, bumper, {}, 1.5);
  cv::normalize(bumper, bumper, 0, 255, cv::NORM_MINMAX);
  for (const int side : {0, 1}) {
    const std::string folder = drive + "/image_" + std::to_string(side);
    for (const auto& file : std::filesystem::directory_iterator(folder)) {
      cv::Mat image = cv::imread(file.path(), cv::IMREAD_GRAYSCALE);
      bumper.colRange(side * kDisparity_px, side * kDisparity_px + covered.width)
          .copyTo(image(covered));
      ASSERT_TRUE(cv::imwrite(file.path(), image));
    }
  }
  cv::Mat mask(first.size(), CV_8UC1, cv::Scalar(0));
  mask(covered).setTo(255);
  ASSERT_TRUE(cv::imwrite(drive + "/mask.png", mask));
}

/// Of the last pose, as a share of the way.
double errorOf(const std::string& drive, const std::string& options = "") {
  const std::string file = drive + "/estimate.txt";
  const CommandResult result = runCommand(std::string(OFFLINE_ODOMETRY) + " " + drive +
                                          " --trajectory " + file + " " + options);
  EXPECT_EQ(result.status, 0) << result.output;
  const Eigen::Isometry3d end = readTrajectory(file).back().T_world_body;
  const Trajectory truth = KittiSequence(drive).groundTruth();
  const Eigen::Isometry3d T_first_last =
      truth.front().T_world_body.inverse() * truth.back().T_world_body;
  return (T_first_last.inverse() * end).translation().norm() / T_first_last.translation().norm();
}

TEST(MaskedDriveTest, ABumperInViewDoesNoHarmIfItIsMasked) {
  const TemporaryDirectory directory;
  const std::string drive = directory / "drive";
  const CommandResult rendered =
      runCommand(std::string(SIMULATE_DRIVE) + " slip_road " + drive +
                 " --size 480x240 --focal 300 --frames " + std::to_string(kPairs));
  ASSERT_EQ(rendered.status, 0) << rendered.output;
  const double free = errorOf(drive);
  coverByBumper(drive);
  const double covered = errorOf(drive);
  const double masked = errorOf(drive, "--set mask=" + drive + "/mask.png");
  const std::string errors =
      cv::format("error in %% of the way: free %.3f, covered %.3f, masked %.3f",
                 100.0 * free,
                 100.0 * covered,
                 100.0 * masked);
  RecordProperty("errors", errors);
  // As of drives with nothing in view: an error of the rig by 0.1 degrees is 0.2 % in direction.
  EXPECT_LT(masked, 0.01) << errors;
  // What is tracked on the bumper agrees that the camera rests.
  EXPECT_GT(covered, 0.5) << errors;
}

}  // namespace
}  // namespace rotrocc
