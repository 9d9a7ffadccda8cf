// Runs the program, as users do.

#include <string>

#include <gtest/gtest.h>

#include "support/read_file.h"
#include "support/run_command.h"
#include "support/synthetic_sequence.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

CommandResult run(const std::string& arguments) {
  return runCommand(std::string(KITTI_ODOMETRY) + " " + arguments);
}

TEST(KittiOdometryTest, WritesTheBytesOfOfflineOdometry) {
  const TemporaryDirectory directory;
  const std::string sequence = directory / "sequence";
  const std::string config = directory / "config.yaml";
  writeSyntheticSequence(sequence, 6);
  ASSERT_EQ(runCommand("echo 'feature_detector: {max_features: 900}' >" + config).status, 0);
  const CommandResult result = run(sequence + " " + (directory / "kitti.txt") + " " + config);
  ASSERT_EQ(result.status, 0) << result.output;
  const CommandResult offline =
      runCommand(std::string(OFFLINE_ODOMETRY) + " " + sequence + " --config " + config +
                 " --trajectory " + (directory / "offline.txt"));
  ASSERT_EQ(offline.status, 0) << offline.output;
  const std::string trajectory = readFile(directory / "kitti.txt");
  EXPECT_FALSE(trajectory.empty());
  EXPECT_EQ(trajectory, readFile(directory / "offline.txt"));
}

TEST(KittiOdometryTest, NamesWhatIsMissing) {
  EXPECT_EQ(run("--help").status, 0);
  EXPECT_EQ(run("").status, 2);
  const CommandResult result = run("/no/sequence /no/trajectory.txt");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.output.find("/no/sequence"), std::string::npos) << result.output;
}

}  // namespace
}  // namespace rotrocc
