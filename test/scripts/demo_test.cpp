// Runs scripts/demo on small drives, with the programs of this build.

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "support/background_command.h"
#include "support/read_file.h"
#include "support/run_command.h"
#include "support/temporary_directory.h"
#include "support/wait_until.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

class DemoTest : public ::testing::Test {
 protected:
  std::string demo(const std::string& arguments) const {
    return "env ROTROCC_PREBUILT=1 ROTROCC_BUILD_DIR=" BUILD " XDG_CACHE_HOME=" +
           directory_ / "cache" + " DISPLAY= ROS_LOG_DIR=" + directory_ / "log" + " " DEMO " " +
           arguments;
  }

  std::string cachePath(const std::string& name) const {
    return directory_ / "cache/rotrocc/" + name;
  }

  /// Whether a process is left that the demo has started, by the environment that it inherited.
  bool isRunning() const {
    const std::string mark = "XDG_CACHE_HOME=" + (directory_ / "cache");
    const fs::directory_iterator processes("/proc");
    return std::any_of(begin(processes), end(processes), [&](const fs::directory_entry& process) {
      const std::string path = process.path().string() + "/environ";
      return fs::exists(path) && readFile(path).find(mark) != std::string::npos;
    });
  }

  TemporaryDirectory directory_;
};

TEST_F(DemoTest, ReplaysADriveWhileItIsRenderedAndKeepsIt) {
  const std::string options = "--headless --drive 'parking --size 310x94 --focal 180 --frames 12'";
  const CommandResult first = runCommand(demo(options));
  EXPECT_EQ(first.status, 0) << first.output;
  const auto expectPart = [](const CommandResult& run, const std::string& part) {
    EXPECT_NE(run.output.find(part), std::string::npos) << part << " in " << run.output;
  };
  expectPart(first, "replaying the drive while it is being rendered");
  expectPart(first, "12 pairs played, 12 answered");
  expectPart(first, ", 0 dropped");
  expectPart(first, "\naccuracy    translation");
  expectPart(first, "/report/index.html\ntry next\n");
  EXPECT_FALSE(isRunning());

  const CommandResult second = runCommand(demo(options));
  EXPECT_EQ(second.status, 0) << second.output;
  EXPECT_EQ(second.output.find("rendered"), std::string::npos) << second.output;
  expectPart(second, "12 pairs played, 12 answered");
}

TEST_F(DemoTest, LeavesNothingWhenItIsInterrupted) {
  BackgroundCommand run(demo("--headless --drive parking"), directory_ / "output.txt");
  const bool is_playing = waitUntil([&] {
    return readFile(directory_ / "output.txt").find("stereo camera from P") != std::string::npos;
  });
  EXPECT_TRUE(is_playing) << readFile(directory_ / "output.txt");
  EXPECT_TRUE(fs::exists(cachePath("drives/parking.part")));
  run.interrupt();
  EXPECT_TRUE(waitUntil([&] { return !isRunning(); }));
  EXPECT_TRUE(fs::is_empty(cachePath("drives")));
}

TEST_F(DemoTest, SaysWhatItCannotShow) {
  const std::pair<const char*, const char*> kRows[] = {
      {"--headless --drive nowhere", "the drive is not rendered: simulate_drive: "},
      {"--fast", "unknown option --fast"},
      {"--drive", "--drive needs a scenario"},
      {"/nowhere", "/nowhere does not exist"},
      {"/tmp --drive city", "--drive is instead of a recording"}};
  for (const auto& [arguments, error] : kRows) {
    const CommandResult run = runCommand(demo(arguments));
    EXPECT_NE(run.status, 0) << arguments;
    EXPECT_NE(run.output.find(error), std::string::npos) << run.output;
  }
  EXPECT_TRUE(fs::is_empty(cachePath("drives")));
}

}  // namespace
}  // namespace rotrocc
