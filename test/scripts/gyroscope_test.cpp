// Runs scripts/gyroscope on a short drive.

#include <algorithm>

#include <gtest/gtest.h>

#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

TEST(GyroscopeScriptTest, ComparesWithAndWithoutAGyroscope) {
  const TemporaryDirectory directory;
  const std::string clip = directory / "clip";
  const CommandResult rendered =
      runCommand(std::string(PROGRAMS) + "/simulate_drive handheld " + clip +
                 " --size 376x240 --focal 229 --rate 20 --frames 13");
  ASSERT_EQ(rendered.status, 0) << rendered.output;
  const CommandResult result = runCommand("(" + std::string(PYTHON) + " " + GYROSCOPE + " " + clip +
                                          " --every 1 2 --output " + directory / "out" +
                                          " --programs " + PROGRAMS + " 2>/dev/null)");
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 6) << result.output;
  for (const char* row : {"| clip | 1 | ", " deg | no | ", "| clip | 2 | ", " deg | yes | "}) {
    EXPECT_NE(result.output.find(row), std::string::npos) << row << result.output;
  }
}

}  // namespace
}  // namespace rotrocc
