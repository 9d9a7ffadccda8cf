#include <string>

#include <gtest/gtest.h>

#include "support/run_command.h"
#include "support/slow_build.h"

namespace rotrocc {
namespace {

TEST(SoakTest, AccountsForAllImagesOfAShortRun) {
  if (isSlowBuild()) GTEST_SKIP() << "it starts a manager without the sanitizer";
  const CommandResult soak =
      runCommand("env ROTROCC_PREBUILT=1 ROTROCC_BUILD_DIR=" BUILD " " SOAK " --duration 10");
  EXPECT_EQ(soak.status, 0) << soak.output;
  EXPECT_NE(soak.output.find("passed"), std::string::npos) << soak.output;
}

/// Samples of 4000 s with waves of 20 s: freed memory that stays is no growth, what leaks is.
TEST(SoakTest, JudgesMemoryAndThreads) {
  const struct {
    const char* sample;
    const char* faults;
  } kRows[] = {{"(t, 30 + t / 400 + (10 - t / 400) * (t % 20 / 19), 16)", "[]"},
               {"(t, 30 + (10 + t / 400) * (t % 20 / 19), 16)", "[]"},
               {"(t, 30 + 10 * (t % 20 / 19) + t * 2 / 3600, 16)", "['memory grows']"},
               {"(t, 30, 16 if t < 2500 else 17)", "['threads are added']"},
               {"(t, 30, 17 if 2500 < t < 2600 else 16)", "[]"}};
  for (const auto& row : kRows) {
    const CommandResult result =
        runCommand("cd " TOOLS " && PYTHONPATH=" BUILD
                   "/devel/lib/python3/dist-packages:$PYTHONPATH /usr/bin/python3 -c \"import "
                   "soak_watch; print(soak_watch.faults_of([" +
                   std::string(row.sample) + " for t in range(4000)]))\"");
    EXPECT_NE(result.output.find(row.faults), std::string::npos) << result.output;
  }
}

}  // namespace
}  // namespace rotrocc
