// Runs scripts/watch_process on samples of an hour.

#include <cmath>
#include <functional>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

class WatchProcessTest : public ::testing::Test {
 protected:
  using OfTime = std::function<double(double time_s)>;

  /// One sample a second.
  CommandResult judge(const OfTime& memory_mb, const OfTime& threads) const {
    std::ostringstream rows;
    rows << "time_s,memory_mb,threads,cpu_s\n";
    for (int time_s = 0; time_s <= 3600; ++time_s) {
      rows << time_s << ',' << memory_mb(time_s) << ',' << threads(time_s) << ',' << 0.05 * time_s
           << '\n';
    }
    return runCommand(WATCH_PROCESS " " + directory_.write("samples.csv", rows.str()));
  }

  /// Between a minimum and 40 MB, once in 20 s.
  static double inWaves(double time_s, double lowest_mb) {
    return lowest_mb + (40.0 - lowest_mb) * (std::fmod(time_s, 20.0) / 19.0);
  }

  static double sixteen(double) { return 16.0; }

  TemporaryDirectory directory_;
};

TEST_F(WatchProcessTest, FreedMemoryThatStaysIsNoGrowth) {
  const CommandResult result =
      judge([](double time_s) { return inWaves(time_s, 30.0 + time_s / 400.0); }, sixteen);
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find("0.00 MB an hour"), std::string::npos) << result.output;
}

TEST_F(WatchProcessTest, AllocatedMemoryThatGrowsIs) {
  const double growth_mb_per_s = 2.0 / 3600.0;  // twice the limit
  const auto memory_mb = [&](double time_s) {
    return inWaves(time_s, 30.0) + growth_mb_per_s * time_s;
  };
  const CommandResult result = judge(memory_mb, sixteen);
  EXPECT_EQ(result.status, 1) << result.output;
  EXPECT_NE(result.output.find("+2.00 MB an hour"), std::string::npos) << result.output;
}

TEST_F(WatchProcessTest, NorMayThreadsGrow) {
  const auto constant = [](double) { return 40.0; };
  const auto grows = [](double time_s) { return time_s < 2500.0 ? 16.0 : 17.0; };
  EXPECT_EQ(judge(constant, grows).status, 1);
  const auto moment = [](double time_s) {
    return time_s < 2500.0 || time_s > 2600.0 ? 16.0 : 17.0;
  };
  EXPECT_EQ(judge(constant, moment).status, 0) << "one that is there for a moment does not count";
}

}  // namespace
}  // namespace rotrocc
