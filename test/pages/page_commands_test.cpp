// Follows the README and each page as a user does who copies and pastes: runs the commands of their
// code blocks one after the other, and expects the output that the page prints.
//
// A block marked ```sh has commands, one marked ```console commands after "$ " and what they print.
// Blocks with other marks or without one are not for the shell. The tables below list what is
// replaced in the commands, and which of them are left out and why.

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pages/pages.h"
#include "support/background_command.h"
#include "support/read_file.h"
#include "support/run_command.h"
#include "support/slow_build.h"
#include "support/temporary_directory.h"
#include "support/wait_until.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

/// The folder that the commands of a page run in: that of the sources with the user's recordings.
const std::string kRecordings = R"(set -e
simulate=)" PROGRAMS R"(/simulate_drive
for name in config experiments scripts; do ln -s )" ROOT R"(/$name; done
mkdir -p dataset/sequences dataset/poses EUROC_DIR
$simulate motorway dataset/sequences/06 --frames 50 --size 310x94 --focal 180
mv dataset/sequences/06/poses.txt dataset/poses/06.txt
$simulate slip_road MH_01_easy --layout asl --imu --frames 40 --size 310x94 --focal 180
cp -r MH_01_easy EUROC_DIR
)";

/// What the test replaces in the commands of the pages.
struct Difference {
  std::string page;
  std::string test;
};
const Difference kDifferences[] = {
    // rostest has started a master.
    {"roscore", "rosnode list"},
    // rosrun finds no programs in the folder build of the sources.
    {"rosrun rotrocc ", PROGRAMS "/"},
    // There is no display.
    {"kitti.launch bag:=", "kitti.launch rviz:=false bag:="},
    {"replay.launch bag:=", "replay.launch rviz:=false bag:="},
    // A quarter of the pixels, which are rendered in 10 s.
    {"--size 620x188 --focal 359", "--size 310x94 --focal 180"},
    // Short drives of small images.
    {"simulate_drive city ", "simulate_drive --frames 3 city "},
    {"--poses 03.txt ", "--frames 3 --poses dataset/poses/06.txt "},
    {"--rate 20 --imu", "--rate 20 --imu --frames 30 --size 310x94 --focal 180"},
    // All steps fit into one drive, and a busy machine keeps up with it.
    {"rosbag play ", "rosbag play --rate 0.5 "},
    // Any calibration will do.
    {"LEFT.yaml", "config/cameras/euroc_left.yaml"},
};

/// Commands that contain `part` do not run here, or only where a check succeeds.
struct Omission {
  std::string part;
  std::string reason;  ///< or the check that fails
  bool has_check = false;
};
const Omission kOmissions[] = {
    {"scripts/demo", "demo_test runs it"},
    {"scripts/test", "runs this test"},
    {"cmake -S", "builds the package"},
    {"make -C build", "builds the package"},
    {"apt install", "installs packages"},
    {"--sshlogin", "needs other machines"},
    {"realsense.launch", "needs a camera with its driver"},
    {"/camera/stereo_module", "needs a camera with its driver"},
    {"cameracalibrator.py", "needs a camera with its driver"},
    {"experiments/", "takes minutes to hours; experiments_test runs short forms"},
    {"06_000_050", "a clip of KITTI"},
    {"devel/setup.bash", "the environment of the tests is set up"},
    {"ekf.launch", "rospack find robot_localization", true},
    {"/odometry/filtered", "rospack find robot_localization", true},
    {"kitti_benchmark", "command -v parallel", true},
    {"view_frames.py", "command -v dot", true},
};

/// Parts of the commands whose numbers are those of the page, whatever the drive.
const std::string kExact[] = {"/status/state", "echo.py base_link stereo_left_optical"};

/// Beginnings of the commands that go on during later ones, or until they are started anew.
const std::string kDrive = "rosbag play";
const std::string kLasting[] = {kDrive,
                                "roslaunch rotrocc ekf",
                                "roslaunch rotrocc stereo_odometry",
                                "rosrun tf2_ros static_transform_publisher",
                                PROGRAMS "/publish_camera_info"};
/// Of these, the first and the second are in place of each other.
const std::string kOdometry[] = {kLasting[1], kLasting[2]};

/// Output arrives line by line.
const std::string kLikeATerminal = "export PYTHONUNBUFFERED=1 ROSCONSOLE_STDOUT_LINE_BUFFERED=1\n";

struct Command {
  std::string text;                  ///< for the shell
  std::vector<std::string> printed;  ///< lines below it
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

bool beginsWith(const std::string& text, const std::string& part) {
  return text.rfind(part, 0) == 0;
}

/// Those of the code blocks for the shell.
std::vector<Command> readCommands(const std::string& page) {
  std::vector<Command> commands;
  std::string block;  // its mark, with "```"
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    const bool is_console = block == "```console";
    if (beginsWith(line, "```")) {
      block = block.empty() ? line : "";
    } else if (block != "```sh" && !is_console) {
      continue;
    } else if (!commands.empty() && commands.back().text.back() == '\\') {
      commands.back().text += "\n" + line;
    } else if (!is_console) {
      if (!line.empty()) commands.push_back({line, {}});
    } else if (beginsWith(line, "$ ")) {
      commands.push_back({line.substr(2), {}});
    } else if (!commands.empty()) {
      commands.back().printed.push_back(line);
    }
  }
  return commands;
}

std::string withDifferences(std::string command) {
  for (const Difference& difference : kDifferences) {
    const std::size_t position = command.find(difference.page);
    if (position != std::string::npos) {
      command.replace(position, difference.page.size(), difference.test);
    }
  }
  return command;
}

/// Why a command does not run here; empty if it does.
std::string reasonToOmit(const Command& command) {
  for (const Omission& omission : kOmissions) {
    if (!contains(command.text, omission.part)) continue;
    if (!omission.has_check || runCommand(omission.reason).status != 0) return omission.reason;
  }
  return "";
}

/// Of the lines that are like one of the page: with any numbers, unless these are exact, with
/// anything in place of [...], and with other widths of columns.
std::regex patternOf(const std::string& printed, bool exact) {
  std::string pattern = printed;
  const auto replace = [&](const char* part, const char* by) {
    pattern = std::regex_replace(pattern, std::regex(part), by);
  };
  replace(R"([\^$\\.*+?()\[\]{}|])", R"(\$&)");
  replace(R"(\\\[\\\.\\\.\\\.\\\])", R"(\[[^\]]*\])");
  if (!exact)
    replace(R"((\\\+|-)?\d+(\\\.\d*)?(e(\\\+|-)?\d+)?)", R"([-+]?\d+(\.\d*)?(e[-+]?\d+)?)");
  replace("=+", "=+");
  replace(" +|$", " *");
  return std::regex(pattern);
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

/// Made once for all pages.
const TemporaryDirectory& recordings() {
  static const TemporaryDirectory directory;
  static const CommandResult made = runCommand("(cd " + directory / "" + "\n" + kRecordings + ")");
  if (made.status != 0) throw std::runtime_error(made.output);
  return directory;
}

class PageCommandsTest : public ::testing::TestWithParam<fs::path> {
 protected:
  void SetUp() override {
    runCommand("rosparam delete /use_sim_time");  // of the page before
    const CommandResult made = runCommand("cp -a " + recordings() / "." + " " + directory_ / "");
    ASSERT_EQ(made.status, 0) << made.output;
  }

  /// Runs a command until it has ended or, if it goes on, has printed what the page prints.
  void follow(const Command& command) {
    const auto begins = [&](const std::string& part) { return beginsWith(command.text, part); };
    const auto* lasting = std::find_if(std::begin(kLasting), std::end(kLasting), begins);
    const bool lasts = lasting != std::end(kLasting);
    if (lasts) running_.erase(*lasting);
    if (std::any_of(std::begin(kOdometry), std::end(kOdometry), begins)) {
      for (const std::string& odometry : kOdometry) running_.erase(odometry);
    }
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

  /// Of the last command, in whole lines and without colors.
  std::string output() const {
    static const std::regex kColor("\x1b\\[[0-9;]*m");
    const std::string text = readFile(log());
    return std::regex_replace(text.substr(0, text.rfind('\n') + 1), kColor, "");
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
    const bool drops = contains(command.text, "/status/drops") && contains(output, "reason");
    return isPrinted(command, output) && !drops;
  }

  int started_ = 0;
  Command drive_;
  std::map<std::string, Running> running_;  ///< by the beginnings of the commands
};

TEST_P(PageCommandsTest, PrintWhatThePagePrints) {
  if (isSlowBuild()) GTEST_SKIP() << "the launch file starts a manager without the sanitizer";
  for (Command command : readCommands(readFile(GetParam()))) {
    const std::string reason = reasonToOmit(command);
    std::cout << command.text << (reason.empty() ? "" : "\n    left out: " + reason) << std::endl;
    if (!reason.empty()) continue;
    command.text = withDifferences(command.text);
    ASSERT_NO_FATAL_FAILURE(follow(command));
    ASSERT_FALSE(HasFailure()) << command.text << "\n" << output();
  }
  expectLastingOnesToGoOn();
}

std::string nameOf(const ::testing::TestParamInfo<fs::path>& page) {
  const fs::path& path = page.param;
  return path.stem() == "README" && path.parent_path() != ROOT
             ? path.parent_path().filename().string()
             : path.stem().string();
}

INSTANTIATE_TEST_SUITE_P(Page, PageCommandsTest, ::testing::ValuesIn(pages()), nameOf);

}  // namespace
}  // namespace rotrocc
