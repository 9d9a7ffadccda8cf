// The program check_rig, as a user runs it.

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "support/read_file.h"
#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string simulate(const TemporaryDirectory& directory, const std::string& options) {
  const std::string path = directory / "drive";
  const CommandResult result = runCommand(std::string(SIMULATE_DRIVE) + " slip_road " + path +
                                          " --frames 30 --size 310x94 --focal 180 " + options);
  EXPECT_EQ(result.status, 0) << result.output;
  return path;
}

TEST(CheckRigTest, AGoodRigHasAPageAndStatus0) {
  const TemporaryDirectory directory;
  const std::string report = directory / "report";
  const std::string check = std::string(CHECK_RIG) + " " + simulate(directory, "") + " --report ";
  const CommandResult result = runCommand(check + report);
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_TRUE(contains(result.output, "0 to fix, ")) << result.output;
  const std::string page = readFile(report + "/index.html");
  for (const char* section :
       {"Findings", "Inputs", "Photometry", "Rows", "Disparities", "What is seen"}) {
    EXPECT_TRUE(contains(page, std::string("<h2>") + section + "</h2>")) << section;
  }
  EXPECT_FALSE(contains(page, "src=\"http")) << "it opens alone";
  EXPECT_FALSE(contains(page, "nan +-"));
}

TEST(CheckRigTest, ABadRigHasStatus3AndACorrectedCalibration) {
  const TemporaryDirectory directory;
  const std::string info = directory / "info";
  const std::string report = directory / "report";
  const std::string drive = simulate(directory, "--rows 1");
  const CommandResult result = runCommand(std::string(CHECK_RIG) + " " + drive + " --report " +
                                          report + " --write-camera-info " + info);
  EXPECT_EQ(result.status, 3) << result.output;
  EXPECT_TRUE(contains(result.output, "FIX         rows: row of the right principal point"))
      << result.output;
  EXPECT_TRUE(fs::exists(info + "/left.yaml"));
  EXPECT_TRUE(contains(readFile(info + "/right.yaml"), "projection_matrix"));
  EXPECT_TRUE(contains(readFile(report + "/index.html"), "With the corrected calibration"));
}

TEST(CheckRigTest, SaysWhatIsWrongWithItsUse) {
  EXPECT_EQ(runCommand(CHECK_RIG).status, 2);
  const CommandResult none = runCommand(std::string(CHECK_RIG) + " /no/such.bag");
  EXPECT_EQ(none.status, 1);
  EXPECT_TRUE(contains(none.output, "/no/such.bag")) << none.output;
}

}  // namespace
}  // namespace rotrocc
