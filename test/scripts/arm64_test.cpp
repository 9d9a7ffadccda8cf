// What scripts/arm64 does without a cross compiler. The rest takes too long for each test run.

#include <string>

#include <gtest/gtest.h>

#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

TEST(Arm64Test, ShowsItsUsage) {
  const CommandResult help = runCommand(ARM64 " --help");
  EXPECT_EQ(help.status, 0);
  for (const char* option : {"--setup", "--test", "--compare", "--cost"}) {
    EXPECT_NE(help.output.find(option), std::string::npos) << help.output;
  }
  EXPECT_EQ(runCommand(ARM64 " --unknown").status, 2);
  EXPECT_EQ(runCommand(INSTRUCTION_COSTS " --help").status, 0);
}

TEST(Arm64Test, NamesTheMissingSetup) {
  const TemporaryDirectory directory;
  const CommandResult result =
      runCommand("ROTROCC_ARM64_DIR=" + (directory / "arm64") + " " ARM64 " --test");
  EXPECT_NE(result.status, 0);
  EXPECT_NE(result.output.find("run scripts/arm64 --setup"), std::string::npos) << result.output;
}

}  // namespace
}  // namespace rotrocc
