// Runs scripts/setup with stand-ins for dpkg-query, apt and id, so that nothing is installed.

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

class SetupTest : public ::testing::Test {
 protected:
  SetupTest() {
    // The real list, without the packages of missing.txt.
    command("dpkg-query",
            "for package in $(grep -o -E '[a-z0-9.+-]+' " SETUP
            " | sort -u); do\n"
            "  grep -q -x -e \"$package\" " +
                directory_ / "missing.txt" + " || echo \"|installed|$package|\"\ndone");
    command("id", "echo 0");
    command("apt-cache", "echo '  Candidate: 1.0'");
    command("apt-get",
            "echo \"$@\" >>" + directory_ / "apt.txt" +
                "\n[ \"$1\" != install ] || echo 'Need to get 5 MB of archives.'");
    setMissing("");
  }

  void command(const std::string& name, const std::string& body) const {
    const std::string path = directory_.write(name, "#!/bin/sh\n" + body + "\n");
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  }

  void setMissing(const std::string& packages) const { directory_.write("missing.txt", packages); }

  CommandResult setup(const std::string& arguments = "") const {
    return runCommand("PATH=" + directory_ / "" + ":/usr/bin:/bin " SETUP " " + arguments +
                      " </dev/null");
  }

  /// With a terminal, on which the user types an answer.
  CommandResult setupOnTerminal(const std::string& answer) const {
    return runCommand("echo " + answer + " | PATH=" + directory_ / "" +
                      ":/usr/bin:/bin script -qec " SETUP " /dev/null");
  }

  std::string aptCalls() const {
    std::ifstream file(directory_ / "apt.txt");
    return {std::istreambuf_iterator<char>(file), {}};
  }

  TemporaryDirectory directory_;
};

TEST_F(SetupTest, DoesNothingIfAllIsInstalled) {
  const CommandResult result = setup();
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find("packages are installed"), std::string::npos) << result.output;
  EXPECT_EQ(aptCalls(), "");
}

TEST_F(SetupTest, TellsWhatAndHowMuchBeforeItInstalls) {
  setMissing("g++\n");
  const CommandResult result = setup();
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find("to install: g++\nNeed to get 5 MB"), std::string::npos)
      << result.output;
  EXPECT_NE(aptCalls().find("-y -qq g++"), std::string::npos) << aptCalls();
}

TEST_F(SetupTest, InstallsFurtherPackages) {
  setMissing("rotrocc-example\n");
  const CommandResult result = setup("rotrocc-example");
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_NE(aptCalls().find("-y -qq rotrocc-example"), std::string::npos) << aptCalls();
}

TEST_F(SetupTest, AsksOnATerminal) {
  if (runCommand("script -qec true /dev/null").status != 0) {
    GTEST_SKIP() << "needs a pseudo-terminal: mount /dev/pts";
  }
  setMissing("g++\n");
  const CommandResult refused = setupOnTerminal("n");
  EXPECT_NE(refused.status, 0) << refused.output;
  EXPECT_EQ(aptCalls().find("-y -qq"), std::string::npos) << aptCalls();
  const CommandResult agreed = setupOnTerminal("y");
  EXPECT_EQ(agreed.status, 0) << agreed.output;
  EXPECT_NE(aptCalls().find("-y -qq g++"), std::string::npos) << aptCalls();
}

TEST_F(SetupTest, GoesOnWithoutWhatIsNotNeeded) {
  setMissing("clang-format\nparallel\n");
  command("apt-get", "exit 100");  // no network
  const CommandResult result = setup();
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find("for the linters: clang-format"), std::string::npos)
      << result.output;
  EXPECT_NE(result.output.find("for some of the tests and scripts: parallel"), std::string::npos)
      << result.output;
}

TEST_F(SetupTest, FailsWithoutWhatTheBuildNeeds) {
  setMissing("g++\n");
  command("apt-get", "exit 100");
  const CommandResult result = setup();
  EXPECT_EQ(result.status, 1) << result.output;
  EXPECT_NE(result.output.find("for building and running: g++"), std::string::npos)
      << result.output;
}

TEST_F(SetupTest, NamesPackagesThatTheReleaseLacks) {
  setMissing("g++\n");
  command("apt-cache", "echo '  Candidate: (none)'");
  const CommandResult result = setup();
  EXPECT_EQ(result.status, 1) << result.output;
  EXPECT_NE(result.output.find("apt knows no package g++"), std::string::npos) << result.output;
}

}  // namespace
}  // namespace rotrocc
