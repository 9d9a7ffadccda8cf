// What scripts/demo and scripts/test show of a build, from the lines of make.

#include <string>

#include <gtest/gtest.h>

#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

TEST(BuildProgressTest, IsALineForEveryTenPercentWithWarnings) {
  const TemporaryDirectory directory;
  const std::string script = directory.write("show.sh",
                                             "set -euo pipefail\n. " ENVIRONMENT
                                             "\nshow_progress all <<END\n"
                                             "[  3%] Building CXX object src/rotrocc.cpp.o\n"
                                             "/src/fit.cpp:3:4: warning: unused variable\n"
                                             "[ 31%] Linking CXX shared library librotrocc.so\n"
                                             "[ 38%] Built target rotrocc\n"
                                             "[100%] Built target all\n"
                                             "END\necho done\n");
  const CommandResult run = runCommand("bash " + script + " | sed 's/^.* s. //'");
  EXPECT_EQ(run.output,
            "building all: 3 %\n/src/fit.cpp:3:4: warning: unused variable\n"
            "building all: 31 %\nbuilding all: 100 %\ndone\n");
}

}  // namespace
}  // namespace rotrocc
