// Runs scripts/soak: for a short time, and --summarize on samples of an hour.

#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/run_command.h"
#include "support/slow_build.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

using OfTime = std::function<double(double time_s)>;

/// Memory between a minimum and 40 MB, once in 20 s.
double inWaves(double time_s, double lowest_mb) {
  return lowest_mb + (40.0 - lowest_mb) * (std::fmod(time_s, 20.0) / 19.0);
}

double constant(double) {
  return 16.0;
}

struct Case {
  const char* name;
  OfTime memory_mb, threads;
  int status;
  std::string part;
};

const std::vector<Case> kCases = {
    {"freed memory that stays is no growth",
     [](double time_s) { return inWaves(time_s, 30.0 + time_s / 400.0); },
     constant,
     0,
     "0.00 MB an hour"},
    {"peaks of a machine that gets busier are none",
     [](double time_s) {
       return 30.0 + (10.0 + time_s / 400.0) * (std::fmod(time_s, 20.0) / 19.0);
     },
     constant,
     0,
     "0.00 MB an hour"},
    {"allocated memory that grows by twice the limit is",
     [](double time_s) { return inWaves(time_s, 30.0) + time_s * 2.0 / 3600.0; },
     constant,
     1,
     "+2.00 MB an hour"},
    {"threads must not grow",
     constant,
     [](double time_s) { return time_s < 2500.0 ? 16.0 : 17.0; },
     1,
     "16 in the first half, 17 in the second"},
    {"a thread that is there for a moment does not count",
     constant,
     [](double time_s) { return time_s < 2500.0 || time_s > 2600.0 ? 16.0 : 17.0; },
     0,
     "at most 17"}};

TEST(SoakTest, RunsTwentySecondsWithFaults) {
  if (isSlowBuild()) GTEST_SKIP() << "it starts a manager without the sanitizer";
  const CommandResult soak =
      runCommand("env ROTROCC_PREBUILT=1 ROTROCC_BUILD_DIR=" BUILD " " SOAK " --duration 20");
  EXPECT_EQ(soak.status, 0) << soak.output;
  EXPECT_NE(soak.output.find("the counts add up"), std::string::npos) << soak.output;
}

TEST(SoakTest, JudgesMemoryAndThreads) {
  const TemporaryDirectory directory;
  for (const Case& row : kCases) {
    std::ostringstream samples;
    samples << "time_s,memory_mb,threads,cpu_s\n";
    for (int time_s = 0; time_s <= 3600; ++time_s) {
      samples << time_s << ',' << row.memory_mb(time_s) << ',' << row.threads(time_s) << ','
              << 0.05 * time_s << '\n';
    }
    const std::string path = directory.write("samples.csv", samples.str());
    const CommandResult result = runCommand(SOAK " --summarize " + path);
    EXPECT_EQ(result.status, row.status) << row.name << ": " << result.output;
    EXPECT_NE(result.output.find(row.part), std::string::npos) << row.name << ": " << result.output;
  }
}

}  // namespace
}  // namespace rotrocc
