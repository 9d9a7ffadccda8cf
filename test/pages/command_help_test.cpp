// --help of all programs and scripts, and their answer to an unknown option.

#include <filesystem>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/run_command.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

/// What rosrun finds: programs and installed scripts.
std::vector<std::string> programs() {
  std::istringstream stream(PROGRAMS);
  return {std::istream_iterator<std::string>(stream), {}};
}

/// The executables of the folders scripts and experiments.
std::vector<std::string> scripts() {
  std::vector<std::string> paths;
  for (const char* folder : {"scripts", "experiments"}) {
    for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(ROOT) / folder)) {
      const bool runs = (entry.status().permissions() & fs::perms::owner_exec) != fs::perms::none;
      if (entry.is_regular_file() && runs) paths.push_back(entry.path());
    }
  }
  return paths;
}

/// Waits for a ROS master if its options are right.
bool isNode(const std::string& name) {
  return name == "stereo_odometry" || name == "kitti_player" || name == "rviz_scene";
}

CommandResult run(const std::string& path, const std::string& arguments) {
  return runCommand("PATH=/usr/bin:/bin COLUMNS=100 timeout 60 " + path + " " + arguments +
                    " </dev/null");
}

TEST(CommandHelpTest, SaysWhatItIsForWithAnExample) {
  std::vector<std::string> paths = scripts();
  for (const std::string& name : programs())
    paths.push_back(std::string(PROGRAMS_DIR) + "/" + name);
  for (const std::string& path : paths) {
    const CommandResult help = run(path, "--help");
    EXPECT_EQ(help.status, 0) << path;
    static const std::regex form(R"([^\n]{1,119}\.\n\nexample: [^\n]+\nusage:   )");
    EXPECT_TRUE(std::regex_search(help.output, form, std::regex_constants::match_continuous))
        << path << ":\n"
        << help.output;
  }
}

TEST(CommandHelpTest, UnknownOptionsAreRejected) {
  for (const std::string& name : programs()) {
    if (isNode(name)) continue;
    const CommandResult result = run(std::string(PROGRAMS_DIR) + "/" + name, "--no-such-option");
    EXPECT_EQ(result.status, 2) << name;
    EXPECT_NE(result.output.find("--help"), std::string::npos) << name << ": " << result.output;
  }
}

}  // namespace
}  // namespace rotrocc
