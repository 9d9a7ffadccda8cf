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
    return directory_.write(
        "show.sh",
        "set -euo pipefail\n. " ENVIRONMENT
        "\nshow_progress all <<END\n"
        "[  3%] Building CXX object src/CMakeFiles/rotrocc.dir/Unity/unity_2_cxx.cxx.o\n"
        "[  9%] Building CXX object src/kernels/CMakeFiles/rotrocc_avx2.dir/fit_kernels.cpp.o\n"
        "/src/fit_kernels.cpp:3:4: warning: unused variable\n"
        "[ 31%] Linking CXX shared library ../devel/lib/librotrocc.so\n"
        "[ 38%] Built target rotrocc\n"
        "[100%] Built target all\n"
        "END\n");
  }

  TemporaryDirectory directory_;
};

TEST_F(BuildProgressTest, IsALineForEveryTenPercent) {
  const CommandResult run = runCommand("bash " + script());
  EXPECT_EQ(run.status, 0);
  std::string text = run.output;
  for (const char* part : {"building all: 3 %\n",
                           "/src/fit_kernels.cpp:3:4: warning: unused variable\n",
                           "building all: 31 %\n",
                           "building all: 100 %\n"}) {
    const std::size_t at = text.find(part);
    ASSERT_NE(at, std::string::npos) << part << " in this order in " << run.output;
    text = text.substr(at);
  }
  EXPECT_EQ(run.output.find("38 %"), std::string::npos) << run.output;
}

TEST_F(BuildProgressTest, SaysOnATerminalWhatIsBuilt) {
  if (runCommand("script -qec true /dev/null").status != 0) {
    GTEST_SKIP() << "no pseudo-terminals here: mount devpts at /dev/pts";
  }
  const CommandResult run = runCommand("script -qec 'bash " + script() + "' /dev/null");
  EXPECT_EQ(run.status, 0);
  for (const char* part : {"  3 %, compiling rotrocc, part 3",
                           "  9 %, compiling fit_kernels.cpp",
                           "warning: unused variable",
                           " 31 %, linking librotrocc.so",
                           "100 %, built all"}) {
    EXPECT_NE(run.output.find(part), std::string::npos) << part << " in " << run.output;
  }
}

}  // namespace
}  // namespace rotrocc
