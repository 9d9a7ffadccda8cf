// What scripts/demo and scripts/test show of a build, from the lines of make.

#include <string>

#include <gtest/gtest.h>

#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

class BuildProgressTest : public ::testing::Test {
 protected:
  std::string script() const {
    return directory_.write("show.sh",
                            "set -euo pipefail\n. " ENVIRONMENT
                            "\nshow_progress all <<END\n"
                            "[  3%] Building CXX object src/rotrocc.cpp.o\n"
                            "/src/fit_kernels.cpp:3:4: warning: unused variable\n"
                            "[ 31%] Linking CXX shared library ../devel/lib/librotrocc.so\n"
                            "[ 38%] Built target rotrocc\n"
                            "[100%] Built target all\n"
                            "END\n");
  }

  static void expectInOrder(const CommandResult& run, std::initializer_list<const char*> parts) {
    EXPECT_EQ(run.status, 0) << run.output;
    std::size_t at = 0;
    for (const char* part : parts) {
      at = run.output.find(part, at);
      ASSERT_NE(at, std::string::npos) << part << " in this order in " << run.output;
    }
  }

  TemporaryDirectory directory_;
};

TEST_F(BuildProgressTest, IsALineForEveryTenPercent) {
  const CommandResult run = runCommand("bash " + script());
  expectInOrder(run, {"all: 3 %\n", "warning: unused", "all: 31 %\n", "all: 100 %\n"});
  EXPECT_EQ(run.output.find("38 %"), std::string::npos) << run.output;
}

TEST_F(BuildProgressTest, IsOneLineOnATerminal) {
  if (runCommand("script -qec true /dev/null").status != 0) {
    GTEST_SKIP() << "no pseudo-terminals here: mount devpts at /dev/pts";
  }
  const CommandResult run = runCommand("script -qec 'bash " + script() + "' /dev/null");
  expectInOrder(run, {"all:   3 %", "warning: unused", "\r", "all:  31 %", "\r", "all: 100 %"});
}

}  // namespace
}  // namespace rotrocc
