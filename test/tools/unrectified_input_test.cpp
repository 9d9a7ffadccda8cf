// Recordings of raw images, from simulate_drive to the errors of the odometry, as users run them.

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "rotrocc/trajectory.h"
#include "sequences/stereo_sequence.h"
#include "support/read_file.h"
#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

constexpr int kPairs = 10;

/// The start of a drive with a wide radial-tangential and a wide equidistant lens, rendered once.
class UnrectifiedInputTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    drives_ = new TemporaryDirectory;
    for (const std::string lens : {"radtan", "equidistant"}) {
      const CommandResult result =
          runCommand(std::string(SIMULATE_DRIVE) + " slip_road " + *drives_ / lens +
                     " --layout asl --size 480x240 --focal 300 --frames " + std::to_string(kPairs) +
                     " --lens " + lens);
      ASSERT_EQ(result.status, 0) << result.output;
    }
  }
  static void TearDownTestSuite() { delete drives_; }

  static std::string drive(const std::string& lens = "radtan") { return *drives_ / lens; }

  /// The file of the poses of a run that must succeed.
  std::string odometry(const std::string& input, const std::string& options = "") const {
    const std::string file = directory_ / "trajectory.txt";
    const CommandResult result = runCommand(std::string(OFFLINE_ODOMETRY) + " " + input +
                                            " --format tum --trajectory " + file + " " + options);
    EXPECT_EQ(result.status, 0) << result.output;
    return file;
  }

  std::string bag(const std::string& options = "") const {
    const std::string file = directory_ / "drive.bag";
    const CommandResult result =
        runCommand(std::string(SEQUENCE_TO_BAG) + " " + drive() + " " + file + " " + options);
    EXPECT_EQ(result.status, 0) << result.output;
    return file;
  }

  static TemporaryDirectory* drives_;
  TemporaryDirectory directory_;
};

TemporaryDirectory* UnrectifiedInputTest::drives_ = nullptr;

TEST_F(UnrectifiedInputTest, OdometryFollowsTheTruth) {
  for (const std::string lens : {"radtan", "equidistant"}) {
    const Trajectory estimate = readTrajectory(odometry(drive(lens)));
    const Trajectory truth = openStereoSequence(drive(lens), {}).ground_truth;
    ASSERT_EQ(estimate.size(), static_cast<std::size_t>(kPairs));
    ASSERT_EQ(truth.size(), estimate.size());
    EXPECT_EQ(estimate.back().stamp_ns, truth.back().stamp_ns);
    const Eigen::Isometry3d expected =
        truth.front().T_world_body.inverse() * truth.back().T_world_body;
    const Eigen::Isometry3d error = expected.inverse() * estimate.back().T_world_body;
    const double way_m = expected.translation().norm();
    ASSERT_GT(way_m, 5.0);
    // An error of the rectification by 0.1 degrees is one of 0.2 % in direction. Measured: 1.1 %,
    // as all steps are 1 % short in these small images.
    EXPECT_LT(error.translation().norm(), 0.015 * way_m) << lens;
  }
}

TEST_F(UnrectifiedInputTest, TheSequenceIsTheTruthOfAnEvaluation) {
  const std::string estimate = odometry(drive());
  const std::string program = std::string(EVALUATE_TRAJECTORY) + " ";
  const CommandResult result = runCommand(program + drive() + " " + estimate + " --fit");
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find(", 10 poses, "), std::string::npos) << result.output;
  fs::copy(drive(), directory_ / "without", fs::copy_options::recursive);
  fs::remove_all(directory_ / "without/mav0/state_groundtruth_estimate0");
  const CommandResult without = runCommand(program + directory_ / "without" + " " + estimate);
  EXPECT_EQ(without.status, 1);
  EXPECT_NE(without.output.find("has no true poses"), std::string::npos) << without.output;
}

TEST_F(UnrectifiedInputTest, BagsGiveTheSamePoses) {
  const std::string file = odometry(drive());
  const std::string expected = readFile(file);
  const Eigen::Isometry3d end = readTrajectory(file).back().T_world_body;
  EXPECT_TRUE(expected == readFile(odometry(bag())));
  EXPECT_TRUE(expected == readFile(odometry(bag(), "--preload")));
  const CommandResult unrectified = runCommand(std::string(OFFLINE_ODOMETRY) + " " + bag() +
                                               " --rectify no --trajectory /dev/null");
  EXPECT_EQ(unrectified.status, 1);
  EXPECT_NE(unrectified.output.find("no pair has a motion"), std::string::npos);
  // The baseline is rounded.
  const Trajectory rectified = readTrajectory(odometry(bag("--rectify")));
  ASSERT_EQ(rectified.size(), static_cast<std::size_t>(kPairs));
  EXPECT_TRUE(rectified.back().T_world_body.isApprox(end, 1e-6));
}

}  // namespace
}  // namespace rotrocc
