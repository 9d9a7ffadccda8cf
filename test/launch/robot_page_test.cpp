// Follows docs/robot.md as a user does who copies and pastes: runs its commands one after the other
// in the rehearsal, and expects the output that the page prints.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/background_command.h"
#include "support/read_file.h"
#include "support/run_command.h"
#include "support/slow_build.h"
#include "support/temporary_directory.h"
#include "support/wait_until.h"

namespace rotrocc {
namespace {

/// What the test replaces in the commands of the page.
struct Difference {
  std::string page;
  std::string test;
};
const Difference kDifferences[] = {
    // rostest has started a master.
    {"roscore", "rosnode list"},
    // rosrun finds no programs in the folder build of the sources.
    {"rosrun rotrocc ", PROGRAMS "/"},
    // A quarter of the pixels, which are rendered in 10 s.
    {"--size 620x188 --focal 359", "--size 310x94 --focal 180"},
    {"max_disparity_px: 200", "max_disparity_px: 100"},
    // All steps fit into one drive, and a busy machine keeps up with it.
    {"rosbag play ", "rosbag play --rate 0.5 "},
};

/// What a machine may lack.
struct Requirement {
  std::string command;  ///< part of the commands that need it
  std::string check;    ///< a command that fails without it
};
const Requirement kRequirements[] = {
    {"ekf.launch", "rospack find robot_localization"},
    {"/odometry/filtered", "rospack find robot_localization"},
    {"view_frames.py", "command -v dot"},
};

/// Parts of the commands whose numbers are those of the page, whatever the drive.
const std::string kExact[] = {"/status/state", "echo.py base_link stereo_left_optical"};

/// Beginnings of the commands that go on during later steps, or until they are started anew.
const std::string kDrive = "rosbag play";
const std::string kLasting[] = {kDrive, "roslaunch", "rosrun tf2_ros static_transform_publisher"};

/// Output arrives line by line.
const std::string kLikeATerminal = "export PYTHONUNBUFFERED=1 ROSCONSOLE_STDOUT_LINE_BUFFERED=1\n";

struct Command {
  int step;                          ///< of the page; 0: the rehearsal
  std::string text;                  ///< for the shell
  std::vector<std::string> printed;  ///< lines below it
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

bool beginsWith(const std::string& text, const std::string& part) {
  return text.rfind(part, 0) == 0;
}

/// Those of the code blocks, which begin with "$ ".
std::vector<Command> readCommands(const std::string& page) {
  static const std::regex kStep(R"(\*\*(\d+)\. .*)");
  std::vector<Command> commands;
  int step = 0;
  bool is_code = false;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    std::smatch number;
    if (beginsWith(line, "```")) {
      is_code = !is_code;
    } else if (!is_code) {
      if (std::regex_match(line, number, kStep)) step = std::stoi(number[1]);
    } else if (beginsWith(line, "$ ")) {
      commands.push_back({step, line.substr(2), {}});
    } else if (!commands.empty() && commands.back().text.back() == '\\') {
      commands.back().text += "\n" + line;
    } else if (!commands.empty()) {
      commands.back().printed.push_back(line);
    }
  }
  return commands;
}

/// Puts the differences into the commands. Expects that each has a place there.
void replaceDifferences(std::vector<Command>& commands) {
  for (const Difference& difference : kDifferences) {
    bool is_used = false;
    for (Command& command : commands) {
      const std::size_t position = command.text.find(difference.page);
      if (position == std::string::npos) continue;
      command.text.replace(position, difference.page.size(), difference.test);
      is_used = true;
    }
    EXPECT_TRUE(is_used) << "no command of the page has " << difference.page;
  }
}

/// Of the lines that are like one of the page: with any numbers, unless these are exact, with
/// anything in place of [...], and with other widths of columns.
std::regex patternOf(const std::string& printed, bool exact) {
  static const std::string kNumber = R"([-+]?\d+(\.\d*)?(e[-+]?\d+)?)";
  static const std::regex kNumberPattern(kNumber);
  static const std::regex kPart(R"(\[\.\.\.\]| +|=+|)" + kNumber + "|.");
  std::string pattern;
  for (std::sregex_iterator part(printed.begin(), printed.end(), kPart), end; part != end; ++part) {
    const std::string text = part->str();
    if (text == "[...]") {
      pattern += R"(\[[^\]]*\])";
    } else if (text[0] == ' ') {
      pattern += part->position() == 0 ? " *" : " +";
    } else if (text[0] == '=') {
      pattern += "=+";
    } else if (!exact && std::regex_match(text, kNumberPattern)) {
      pattern += kNumber;
    } else {
      pattern += std::regex_replace(text, std::regex(R"([\^$\\.*+?()\[\]{}|])"), R"(\$&)");
    }
  }
  return std::regex(pattern + " *");
}

/// Whether the output has lines like those of the page, in their order.
bool isPrinted(const Command& command, const std::string& output) {
  const auto isPart = [&](const std::string& part) { return contains(command.text, part); };
  const bool exact = std::any_of(std::begin(kExact), std::end(kExact), isPart);
  std::istringstream lines(output);
  const auto follows = [&](const std::string& printed) {
    const std::regex pattern = patternOf(printed, exact);
    for (std::string line; std::getline(lines, line);) {
      if (std::regex_match(line, pattern)) return true;
    }
    return false;
  };
  return std::all_of(command.printed.begin(), command.printed.end(), follows);
}

/// Those of the lines "name: value".
std::vector<double> valuesOf(const std::string& name, const std::string& output) {
  std::vector<double> values;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (beginsWith(line, name + ": ")) values.push_back(std::stod(line.substr(name.size() + 2)));
  }
  return values;
}

/// The most by which a value exceeds an earlier one.
double growthOf(const std::vector<double>& values) {
  double least = std::numeric_limits<double>::infinity();
  double growth = 0.0;
  for (const double value : values) {
    least = std::min(least, value);
    growth = std::max(growth, value - least);
  }
  return growth;
}

class RobotPageTest : public ::testing::Test {
 protected:
  /// Runs a command until it has ended or, if it goes on, has printed what the page prints.
  void follow(const Command& command) {
    const auto begins = [&](const std::string& part) { return beginsWith(command.text, part); };
    const auto* lasting = std::find_if(std::begin(kLasting), std::end(kLasting), begins);
    const bool lasts = lasting != std::end(kLasting);
    if (lasts) running_.erase(*lasting);
    Running run = start(command);
    const bool is_done = waitUntil(
        [&] {
          if (HasFailure() || run->status()) return true;
          if (startDriveAgain()) {
            run.reset();
            run = start(command);
          }
          return (lasts || !command.printed.empty()) && isRight(command);
        },
        std::chrono::milliseconds(100));
    EXPECT_TRUE(is_done) << "it goes on without the output of the page";
    EXPECT_TRUE(isRight(command));
    EXPECT_EQ(run->status().value_or(0), 0);
    if (lasts) running_[*lasting] = std::move(run);
    if (begins(kDrive)) drive_ = command;
  }

  void expectLastingOnesToGoOn() {
    for (const auto& [beginning, run] : running_) {
      if (beginning == kDrive) continue;
      EXPECT_FALSE(run->status()) << beginning;
    }
  }

  /// Of the last command, in whole lines and without colours.
  std::string output() const {
    static const std::regex kColour("\x1b\\[[0-9;]*m");
    const std::string text = readFile(log());
    return std::regex_replace(text.substr(0, text.rfind('\n') + 1), kColour, "");
  }

  TemporaryDirectory directory_;

 private:
  using Running = std::unique_ptr<BackgroundCommand>;

  std::string log() const { return directory_ / ("log_" + std::to_string(started_)); }

  Running start(const Command& command) {
    const std::string name = "command_" + std::to_string(++started_);
    const std::string folder = "cd " + directory_ / "" + "\n";
    const std::string script = directory_.write(name, kLikeATerminal + folder + command.text);
    return std::make_unique<BackgroundCommand>("bash " + script, log());
  }

  /// Plays the bag again if it has ended. The time goes back then, for which the command that waits
  /// for it must start again, too.
  bool startDriveAgain() {
    const auto drive = running_.find(kDrive);
    if (drive == running_.end() || !drive->second->status()) return false;
    EXPECT_EQ(drive->second->status(), 0);
    drive->second = start(drive_);
    return true;
  }

  bool isRight(const Command& command) const {
    // A busy machine may skip pairs. The drive and the node may start between the images of a pair:
    // that is one image each time.
    static const std::regex kUsualDrops(
        R"((- *\n +reason: "(newer_pair_came"\n +count: \d+|no_partner"\n +count: \d)\n)+)");
    const std::string output = std::regex_replace(this->output(), kUsualDrops, "[]\n");
    return isPrinted(command, output) && isMeant(command, output);
  }

  /// What the form of the output does not show.
  bool isMeant(const Command& command, const std::string& output) const {
    if (contains(command.text, "/status/drops")) return !contains(output, "reason");
    if (contains(command.text, "/odom/pose/pose/position")) {
      return growthOf(valuesOf("x", output)) > 1.0;
    }
    if (contains(command.text, "/odometry/visual/pose/pose/position")) {
      return std::abs(valuesOf("z", output).at(0)) < 1e-6;  // planar
    }
    if (contains(command.text, "view_frames.py")) {
      const std::string tree = readFile(directory_ / "frames.gv");
      return contains(tree, R"("odom" -> "base_link")") &&
             contains(tree, R"("base_link" -> "stereo_left_optical")") &&
             !readFile(directory_ / "frames.pdf").empty();
    }
    return true;
  }

  int started_ = 0;
  Command drive_;
  std::map<std::string, Running> running_;  ///< by the beginnings of the commands
};

/// The check that fails for what a command needs; empty if all is there.
std::string missingFor(const Command& command) {
  for (const Requirement& requirement : kRequirements) {
    if (contains(command.text, requirement.command) && runCommand(requirement.check).status != 0) {
      return requirement.check;
    }
  }
  return "";
}

TEST_F(RobotPageTest, CommandsPrintWhatThePagePrints) {
  if (isSlowBuild()) GTEST_SKIP() << "the launch file starts a manager without the sanitizer";
  std::vector<Command> commands = readCommands(readFile(ROBOT_MD));
  std::set<int> steps;
  for (const Command& command : commands) steps.insert(command.step);
  ASSERT_EQ(steps, (std::set<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}));
  replaceDifferences(commands);
  for (const Command& command : commands) {
    const std::string missing = missingFor(command);
    std::cout << "step " << command.step << ": " << command.text
              << (missing.empty() ? "" : "\n    skipped, as this fails: " + missing) << std::endl;
    if (!missing.empty()) continue;
    ASSERT_NO_FATAL_FAILURE(follow(command));
    ASSERT_FALSE(HasFailure()) << "in step " << command.step << ":\n"
                               << command.text << "\n"
                               << output();
  }
  expectLastingOnesToGoOn();
}

}  // namespace
}  // namespace rotrocc
