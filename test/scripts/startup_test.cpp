// Runs scripts/startup once. Times are not checked.

#include <string>

#include <gtest/gtest.h>

#include "support/run_command.h"
#include "support/synthetic_sequence.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

/// The figures of a line that begins with `name`.
struct Start {
  double first_s = 0.0;
  double second_s = 0.0;
  int libraries = 0;
  double memory_mb = 0.0;
};

Start readStart(const std::string& output, const std::string& name) {
  Start start;
  const std::size_t line = output.find("\n" + name + " ");
  EXPECT_NE(line, std::string::npos) << output;
  if (line == std::string::npos) return start;
  const std::string figures = output.substr(line + 1 + name.size());
  EXPECT_EQ(std::sscanf(figures.c_str(),
                        " %lf (%*f to %*f) %lf (%*f to %*f) %d %lf",
                        &start.first_s,
                        &start.second_s,
                        &start.libraries,
                        &start.memory_mb),
            4)
      << figures;
  return start;
}

TEST(StartupTest, MeasuresNodeAndLaunchFile) {
  const TemporaryDirectory directory;
  writeSyntheticSequence(directory / "sequence", 12);
  const CommandResult result = runCommand(
      PYTHON " " STARTUP " --repeat 1 --programs " PROGRAMS " " + directory / "sequence");
  ASSERT_EQ(result.status, 0) << result.output;
  for (const char* name : {"stereo_odometry", "stereo_odometry.launch"}) {
    SCOPED_TRACE(name);
    const Start start = readStart(result.output, name);
    EXPECT_GT(start.first_s, 0.0);
    EXPECT_GE(start.second_s, start.first_s);
    EXPECT_GT(start.libraries, 20) << "those of ROS and OpenCV";
    EXPECT_GT(start.memory_mb, 5.0);
  }
}

TEST(StartupTest, NamesASequenceThatIsMissing) {
  const CommandResult result = runCommand(PYTHON " " STARTUP " none");
  EXPECT_NE(result.status, 0);
  EXPECT_NE(result.output.find("none does not exist"), std::string::npos) << result.output;
}

}  // namespace
}  // namespace rotrocc
