// Runs scripts/performance in its short form, and checks its report. Times are not checked.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/read_csv.h"
#include "support/read_file.h"
#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

TEST(PerformanceTest, FillsTheTablesAndDrawsTheFigure) {
  const TemporaryDirectory directory;
  const std::string report = directory / "performance.md";
  std::ofstream(report) << readFile(REPORT);
  unsetenv("ROTROCC_KITTI_DIR");  // real clips would take long
  const CommandResult result = runCommand(std::string("MPLBACKEND=module://none ") + PYTHON + " " +
                                          PERFORMANCE + " --short --programs " + PROGRAMS +
                                          " --output " + directory / "out" + " --report " + report);
  ASSERT_EQ(result.status, 0) << result.output;

  const std::vector<CsvRow> stages = readCsv(directory / "out/stages.csv");
  ASSERT_EQ(stages.size(), 15u);
  EXPECT_GT(std::stod(stages.front().at("slip_road")), 0.0);
  const std::vector<CsvRow> presets = readCsv(directory / "out/presets.csv");
  ASSERT_EQ(presets.size(), 1u);
  for (const char* preset : {"fast", "default"}) {
    const double error_percent = std::stod(presets.front().at(std::string(preset) + ": error [%]"));
    EXPECT_GT(error_percent, 0.0) << preset;
    EXPECT_LT(error_percent, 5.0) << preset;
  }
  const std::vector<CsvRow> features = readCsv(directory / "out/features.csv");
  ASSERT_EQ(features.size(), 2u);
  EXPECT_LT(std::stod(features[0].at("tracked")), 0.7 * std::stod(features[1].at("tracked")));
  const std::vector<CsvRow> sizes = readCsv(directory / "out/sizes.csv");
  ASSERT_EQ(sizes.size(), 2u);
  EXPECT_LT(std::stod(sizes[0].at("memory [MB]")), std::stod(sizes[1].at("memory [MB]")));

  const std::vector<CsvRow> rates = readCsv(directory / "out/rates.csv");
  ASSERT_EQ(rates.size(), 2u);
  EXPECT_EQ(rates[1].at("cameras [Hz]"), "20");
  EXPECT_GT(std::stod(rates[1].at("default: CPU a minute [s]")), 0.0);

  const std::vector<CsvRow> arrival = readCsv(directory / "out/arrival.csv");
  ASSERT_EQ(arrival.size(), 7u);
  const std::vector<CsvRow> wakeups = readCsv(directory / "out/wakeups.csv");
  ASSERT_EQ(wakeups.size(), 4u);
  for (const char* mode : {"nodelet", "node over TCP"}) {
    EXPECT_GT(std::stod(arrival[4].at(mode + std::string(": p50"))), 0.0) << mode;
    EXPECT_GE(std::stod(wakeups[0].at(mode)), 1.0) << mode;  // with each pair
  }

  EXPECT_GT(std::filesystem::file_size(directory / "cost.png"), 10000u);
  EXPECT_NE(readFile(report).find("| 640x480 | "), std::string::npos);
  EXPECT_EQ(readFile(report).find("| 1920x1200 |"), std::string::npos) << "rows of earlier runs";
}

}  // namespace
}  // namespace rotrocc
