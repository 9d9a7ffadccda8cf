// Runs the program as users do, and compares the images that it writes.

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "support/read_file.h"
#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

class SimulateDriveTest : public ::testing::Test {
 protected:
  CommandResult simulate(const std::string& out, const std::string& options) const {
    return runCommand(std::string(SIMULATE_DRIVE) + " parking " + (directory_ / out) +
                      " --size 310x94 --focal 180 --frames 2 " + options);
  }

  TemporaryDirectory directory_;
};

TEST_F(SimulateDriveTest, WritesRawImagesInAslFormat) {
  ASSERT_EQ(simulate("asl", "--layout asl").status, 0);
  const std::string list = readFile(directory_ / "asl/mav0/cam0/data.csv");
  EXPECT_EQ(list.compare(0, 24, "#timestamp [ns],filename"), 0) << list;
  EXPECT_NE(list.find("1317600000100000000,1317600000100000000.png"), std::string::npos) << list;
  EXPECT_EQ(simulate("asl", "--layout asl").status, 1) << "it has images";
}

TEST_F(SimulateDriveTest, WritesAGyroscope) {
  ASSERT_EQ(simulate("drive", "--imu").status, 0);
  ASSERT_EQ(simulate("alone.csv", "").status, 0);
  const std::string table = readFile(directory_ / "drive/imu.csv");
  EXPECT_EQ(table, readFile(directory_ / "alone.csv"));
  EXPECT_EQ(table.compare(0, 15, "#timestamp [ns]"), 0) << table;
  EXPECT_GE(std::count(table.begin(), table.end(), '\n'), 20) << "0.1 s at 200 Hz";
}

TEST_F(SimulateDriveTest, RejectsWhatDoesNotFit) {
  const auto expectRejected = [&](const std::string& options, const std::string& part) {
    const CommandResult result = simulate("rejected", options);
    EXPECT_NE(result.status, 0) << options;
    EXPECT_NE(result.output.find(part), std::string::npos) << result.output;
  };
  expectRejected("--rows 21", "row offset [px] is 21");
  expectRejected("--moving-share 1.5", "share of moving cars is 1.5");
  expectRejected("--layout tum", "--layout is 'tum', not kitti or asl");
  expectRejected("--layout asl --lens omni", "'omni'");
  expectRejected("--lens radtan", "--lens is for the layout asl");
  expectRejected("--layout asl --truth", "--truth is for the layout kitti");
}

}  // namespace
}  // namespace rotrocc
