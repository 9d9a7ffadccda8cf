// --help of all programs and scripts, their answer to an unknown option, and the completion of
// bash, which knows the options.

#include <filesystem>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> wordsOf(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// What rosrun finds: programs and installed scripts.
std::vector<std::string> programs() {
  return wordsOf(PROGRAMS);
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

std::string helpOf(const std::string& program) {
  return run(std::string(PROGRAMS_DIR) + "/" + program, "--help").output;
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

TEST(CommandHelpTest, UnknownOptionsAreRefused) {
  for (const std::string& name : programs()) {
    if (isNode(name)) continue;
    const CommandResult result = run(std::string(PROGRAMS_DIR) + "/" + name, "--no-such-option");
    EXPECT_EQ(result.status, 2) << name;
    EXPECT_NE(result.output.find("--help"), std::string::npos) << name << ": " << result.output;
  }
}

/// The options of a help, and whether each takes a value.
std::map<std::string, bool> optionsOf(const std::string& help) {
  static const std::regex option(R"(^  (?:-h \[ |-h, )?(--[a-z-]+)(?: \])?( [^ ]+)?)");
  std::map<std::string, bool> options;
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_search(line, match, option)) options[match[1]] = match[2].matched;
  }
  options.erase("--help");
  return options;
}

/// What bash prints with the completion at hand.
std::string withCompletion(const std::string& commands) {
  return runCommand("bash -c '. " ROOT "/scripts/completion.bash; " + commands + "'").output;
}

TEST(CompletionTest, KnowsEveryOptionOfEveryProgram) {
  for (const std::string& name : programs()) {
    if (isNode(name)) continue;
    std::map<std::string, bool> completed;
    const std::string options = "echo ${_rotrocc_options[" + name + "]-unknown}";
    for (std::string word : wordsOf(withCompletion(options))) {
      const bool has_value = word.back() == '=';
      if (has_value) word.pop_back();
      completed[word] = has_value;
    }
    EXPECT_EQ(completed, optionsOf(helpOf(name))) << name;
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
    return withCompletion(
        "cd " + directory_ / "" + "; COMP_WORDS=(" + words +
        "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); "
        "function=$(complete -p ${COMP_WORDS[0]} | sed \"s/.*-F \\([^ ]*\\).*/\\1/\"); "
        "$function 2>/dev/null; printf \"<%s>\" \"${COMPREPLY[@]}\"");
  }

  TemporaryDirectory directory_;
};

TEST_F(CompletedTest, OptionsAndTheirValues) {
  EXPECT_EQ(offered("offline_odometry --tra"), "<--trajectory>");
  EXPECT_EQ(offered("rosrun rotrocc offline_odometry 06 --format k"), "<kitti>");
  EXPECT_EQ(offered("rosrun rotrocc simulate_drive mo"), "<motorway>");
  EXPECT_EQ(offered("rosrun rotrocc offl"), "<offline_odometry>");
}

TEST_F(CompletedTest, RecordingsAndFoldersThatLeadToThem) {
  EXPECT_EQ(offered("rosrun rotrocc offline_odometry dri"), "<drives/>");
  EXPECT_EQ(offered("rosrun rotrocc offline_odometry drives/"), "<drives/06 ><drives/06.bag >");
  EXPECT_EQ(offered("offline_odometry drives/06 --stats drives/re"), "<drives/readme.txt>");
}

}  // namespace
}  // namespace rotrocc
