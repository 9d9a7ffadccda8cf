// --help of all programs and scripts: its form, docs/commands.md, which has it, and the completion
// of bash, which knows the options.

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/expected_file.h"
#include "support/read_file.h"
#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

/// Those that users call, with the part of the page: others serve a test or another script.
const std::vector<std::pair<std::string, std::vector<std::string>>> kPage = {
    {"Odometry and its errors",
     {"offline_odometry",
      "evaluate_trajectory",
      "kitti_benchmark",
      "benchmark",
      "plot_trajectory",
      "draw_report"}},
    {"Recordings", {"sequence_to_bag", "simulate_drive", "stress_sequence", "publish_camera_info"}},
    {"Nodes", {"stereo_odometry", "kitti_player", "rviz_scene"}},
    {"Library", {"kitti_odometry", "error_characteristics"}},
    {"Scripts of the sources",
     {"demo", "setup", "test", "package", "soak", "sanitize", "fuzz", "arm64"}}};

bool isNode(const std::string& name) {
  return name == "stereo_odometry" || name == "kitti_player" || name == "rviz_scene";
}

CommandResult run(const std::string& name, const std::string& arguments) {
  const std::string program = std::string(PROGRAMS_DIR) + "/" + name;
  const std::string script = std::string(SCRIPTS_DIR) + "/" + name;
  return runCommand("PATH=/usr/bin:/bin COLUMNS=100 timeout 60 " +
                    (fs::exists(script) ? script : program) + " " + arguments + " </dev/null");
}

std::vector<std::string> programs() {
  std::vector<std::string> names;
  std::istringstream list(PROGRAMS);
  for (std::string name; list >> name;) {
    if (name != "kitti_to_bag") names.push_back(name);  // prints the name sequence_to_bag
  }
  return names;
}

/// The executables of the folder scripts.
std::vector<std::string> scripts() {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(SCRIPTS_DIR)) {
    const bool runs = (entry.status().permissions() & fs::perms::owner_exec) != fs::perms::none;
    const std::string name = entry.path().filename();
    if (entry.is_regular_file() && runs) names.push_back(name);
  }
  return names;
}

/// The --help of each, which takes a while.
const std::map<std::string, std::string>& helps() {
  static const std::map<std::string, std::string> helps = [] {
    std::map<std::string, std::string> texts;
    for (const auto& names : {programs(), scripts()}) {
      for (const std::string& name : names) {
        const CommandResult result = run(name, "--help");
        EXPECT_EQ(result.status, 0) << name << ": " << result.output;
        texts[name] = result.output;
      }
    }
    return texts;
  }();
  return helps;
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The options of a help, and whether each takes a value.
std::map<std::string, bool> optionsOf(const std::string& help) {
  static const std::regex option(R"(^  (?:-h \[ |-h, )?(--[a-z-]+)(?: \])?( [^ ]+)?)");
  std::map<std::string, bool> options;
  for (const std::string& line : linesOf(help)) {
    std::smatch match;
    if (std::regex_search(line, match, option)) options[match[1]] = match[2].matched;
  }
  options.erase("--help");
  return options;
}

TEST(CommandHelpTest, BeginsWithWhatItIsForAndAnExample) {
  for (const auto& [name, help] : helps()) {
    const std::vector<std::string> lines = linesOf(help);
    ASSERT_GT(lines.size(), 4u) << name << ":\n" << help;
    EXPECT_EQ(lines[0].back(), '.') << name << ": " << lines[0];
    EXPECT_LE(lines[0].size(), 120u) << name;
    EXPECT_EQ(lines[1], "") << name << ": more than one line says what it is for";
    EXPECT_EQ(lines[2].find("example: "), 0u) << name << ": " << lines[2];
    EXPECT_NE(lines[2].find(name), std::string::npos) << lines[2];
    EXPECT_EQ(lines[3].find("usage:   "), 0u) << name << ": " << lines[3];
  }
}

TEST(CommandHelpTest, DescribesEveryOption) {
  static const std::regex described(R"(^  \S.*(  +|\) )\S)");
  for (const auto& [name, help] : helps()) {
    const std::vector<std::string> lines = linesOf(help);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (lines[i].find("  -") != 0) continue;
      const bool on_next_line =
          i + 1 < lines.size() && lines[i + 1].find_first_not_of(' ') >= 12 && lines[i + 1] != "";
      EXPECT_TRUE(std::regex_search(lines[i], described) || on_next_line) << name << lines[i];
    }
  }
}

TEST(CommandHelpTest, ErrorsNameIt) {
  for (const std::string& name : programs()) {
    if (isNode(name)) continue;  // waits for a ROS master
    const CommandResult result = run(name, "--no-such-option");
    EXPECT_EQ(result.status, 2) << name;
    EXPECT_NE(result.output.find("--help"), std::string::npos) << name << ": " << result.output;
  }
}

std::string withoutWrapping(const std::string& text) {
  return std::regex_replace(text, std::regex(R"(\s+)"), " ");
}

/// Releases of Python and Boost break lines at other places.
TEST(CommandHelpTest, CommandsPageIsUpToDate) {
  std::ostringstream page;
  page << "# Commands\n\n"
          "`--help` of each program and script, as it prints it. Programs are run by `rosrun "
          "rotrocc "
          "PROGRAM`, also\nwith completion by the tab key: `. scripts/completion.bash`, or `. "
          "/usr/share/bash-completion/completions/rotrocc`\nof the package. Written by "
          "`command_help_test`.\n";
  for (const auto& [part, names] : kPage) {
    page << "\n## " << part << '\n';
    for (const std::string& name : names) {
      ASSERT_EQ(helps().count(name), 1u) << name;
      page << "\n### " << name << "\n\n```\n" << helps().at(name) << "```\n";
    }
  }
  if (withoutWrapping(readFile(COMMANDS_MD)) != withoutWrapping(page.str())) {
    expectFileHolds(COMMANDS_MD, std::regex_replace(page.str(), std::regex(" +\n"), "\n"));
  }
}

/// The options that the completion has of a program.
std::map<std::string, bool> completedOptions(const std::string& name) {
  const CommandResult result =
      runCommand("bash -c '. " SCRIPTS_DIR "/completion.bash; echo ${_rotrocc_options[" + name +
                 "]-unknown}'");
  std::map<std::string, bool> options;
  std::istringstream words(result.output);
  for (std::string word; words >> word;) {
    const bool has_value = word.back() == '=';
    if (has_value) word.pop_back();
    options[word] = has_value;
  }
  return options;
}

TEST(CompletionTest, KnowsEveryOption) {
  for (const auto& [part, names] : kPage) {
    if (part == "Nodes" || part == "Scripts of the sources") continue;
    for (const std::string& name : names) {
      EXPECT_EQ(completedOptions(name), optionsOf(helps().at(name))) << name;
    }
  }
}

class CompletedTest : public ::testing::Test {
 protected:
  CompletedTest() {
    fs::create_directories(directory_ / "drives/06/image_0");
    directory_.write("drives/06.bag", "");
    directory_.write("drives/readme.txt", "");
  }

  /// What the tab key offers after the words, of which the last one is begun.
  std::string offered(const std::string& words) const {
    return runCommand(
               "cd " + directory_ / "" +
               " && bash -c '. " SCRIPTS_DIR "/completion.bash; COMP_WORDS=(" + words +
               "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); "
               "function=$(complete -p ${COMP_WORDS[0]} | sed \"s/.*-F \\([^ ]*\\).*/\\1/\"); "
               "$function 2>/dev/null; printf \"<%s>\" \"${COMPREPLY[@]}\"'")
        .output;
  }

  TemporaryDirectory directory_;
};

TEST_F(CompletedTest, OptionsAndTheirValues) {
  EXPECT_EQ(offered("offline_odometry --tra"), "<--trajectory>");
  EXPECT_EQ(offered("rosrun rotrocc offline_odometry 06 --format k"), "<kitti>");
  EXPECT_EQ(offered("rosrun rotrocc simulate_drive ni"), "<night>");
  EXPECT_EQ(offered("rosrun rotrocc offl"), "<offline_odometry>");
}

TEST_F(CompletedTest, RecordingsAndFoldersThatLeadToThem) {
  EXPECT_EQ(offered("rosrun rotrocc offline_odometry dri"), "<drives/>");
  EXPECT_EQ(offered("rosrun rotrocc offline_odometry drives/"), "<drives/06 ><drives/06.bag >");
  EXPECT_EQ(offered("offline_odometry drives/06 --stats drives/re"), "<drives/readme.txt>");
}

}  // namespace
}  // namespace rotrocc
