// Runs scripts/benchmark on a small sequence. Times are not checked.

#include <sstream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "support/run_command.h"
#include "support/synthetic_sequence.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

class BenchmarkTest : public ::testing::Test {
 protected:
  BenchmarkTest() { writeSyntheticSequence(sequence(), 14); }

  std::string sequence() const { return directory_ / "sequence"; }

  CommandResult run(const std::string& arguments) const {
    return runCommand(std::string(PYTHON) + " " + BENCHMARK + " --programs " + PROGRAMS + " " +
                      arguments);
  }

  TemporaryDirectory directory_;
};

/// The number that follows `name` in a table, and `column` numbers after it.
double figure(const std::string& table, const std::string& name, int column = 0) {
  const std::size_t row = table.find(name);
  if (row == std::string::npos) throw std::runtime_error("no " + name + " in " + table);
  std::istringstream numbers(table.substr(row + name.size()));
  double number = 0.0;
  for (int i = 0; i <= column; ++i) numbers >> number;
  return number;
}

TEST_F(BenchmarkTest, TellsTimesFeaturesMemoryAndError) {
  const CommandResult result = run(sequence() + " --repeat 1");
  ASSERT_EQ(result.status, 0) << result.output;
  const std::string& table = result.output;
  EXPECT_GT(figure(table, "wall mean [ms]"), 0.0);
  EXPECT_GT(figure(table, "wall median [ms]"), 0.0);
  EXPECT_GE(figure(table, "wall p95 [ms]"), figure(table, "wall median [ms]"));
  EXPECT_GE(figure(table, "wall p99 [ms]"), figure(table, "wall p95 [ms]"));
  EXPECT_GT(figure(table, "cpu mean [ms]"), 0.0);
  for (const char* stage : {"pyramids", "corners", "disparity", "tracking", "estimation"}) {
    const double time_ms = figure(table, std::string(stage) + " [ms]");
    EXPECT_GT(time_ms, 0.0) << stage;
    EXPECT_LT(time_ms, figure(table, "wall mean [ms]")) << stage;
  }
  EXPECT_GT(figure(table, "features tracked"), 100.0);
  EXPECT_GT(figure(table, "process memory [MB]"), figure(table, "odometry memory [MB]"));
  EXPECT_GT(figure(table, "translation error [%]"), 0.0);
  EXPECT_LT(figure(table, "translation error [%]"), 5.0);
}

TEST_F(BenchmarkTest, ComparesParametersInTurns) {
  const CommandResult result =
      run(sequence() + " --repeat 2 --against-set feature_detector/max_features=200");
  ASSERT_EQ(result.status, 0) << result.output;
  const std::string row = "features tracked";
  const double a = figure(result.output, row);
  const double b = figure(result.output, row, 1);
  EXPECT_LT(b, 0.7 * a) << "200 instead of 2000 corners";
  EXPECT_NEAR(figure(result.output, row, 2), b - a, 0.01);
  EXPECT_EQ(figure(result.output, row, 3), 0.0) << "the same in both turns";
  EXPECT_NEAR(figure(result.output, row, 4), b / a, 0.001);
}

TEST_F(BenchmarkTest, SaysWhatIsWrong) {
  const struct {
    std::string arguments;
    int status;
    std::string part;
  } rows[] = {
      {"--repeat 1 --against-programs " + directory_ / "nothing", 1, "odometry is not built"},
      {"--repeat 1 --set feature_detector/max_features=1", 1, "[50, 20000]"},
      {"--repeat 0", 2, "--repeat is 0"}};
  for (const auto& row : rows) {
    const CommandResult result = run(sequence() + " " + row.arguments);
    EXPECT_EQ(result.status, row.status) << row.arguments;
    EXPECT_NE(result.output.find(row.part), std::string::npos) << result.output;
    EXPECT_EQ(result.output.find("Traceback"), std::string::npos) << result.output;
  }
}

}  // namespace
}  // namespace rotrocc
