// Installs the build into a prefix of its own, and uses it as one who has no sources.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <regex>
#include <string>

#include <gtest/gtest.h>

#include "support/read_file.h"
#include "support/run_command.h"
#include "support/synthetic_scene.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

class InstallationTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = std::make_unique<TemporaryDirectory>();
    installed_ = runCommand("cmake --install " BUILD " --prefix " + prefix());
  }
  static void TearDownTestSuite() { directory_.reset(); }

  void SetUp() override { ASSERT_EQ(installed_.status, 0) << installed_.output; }

  static std::string prefix() { return path("prefix"); }
  static std::string path(const std::string& name) { return *directory_ / name; }

  /// Runs a command where only the installed package is known.
  static CommandResult run(const std::string& command) {
    return runCommand(
        "if [ -f /opt/ros/noetic/setup.sh ]; then . /opt/ros/noetic/setup.sh; else "
        "unset ROS_PACKAGE_PATH CMAKE_PREFIX_PATH LD_LIBRARY_PATH; fi; "
        "export ROS_PACKAGE_PATH=" +
        prefix() + "/share:$ROS_PACKAGE_PATH CMAKE_PREFIX_PATH=" + prefix() +
        ":$CMAKE_PREFIX_PATH PATH=/usr/bin:$PATH; " + command);
  }

 private:
  inline static std::unique_ptr<TemporaryDirectory> directory_;
  inline static CommandResult installed_;
};

TEST_F(InstallationTest, ProgramsFindTheirLibraries) {
  writeSyntheticSequence(path("sequence"), 4);
  const CommandResult result = run("rosrun rotrocc offline_odometry " + path("sequence") +
                                   " --trajectory " + path("trajectory.txt"));
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_TRUE(std::filesystem::exists(path("trajectory.txt"))) << result.output;
  // The report is a script with modules of its own.
  const CommandResult report = run("rosrun rotrocc evaluate_trajectory " + path("trajectory.txt") +
                                   " --report " + path("report"));
  EXPECT_EQ(report.status, 0) << report.output;
  EXPECT_TRUE(std::filesystem::exists(path("report/index.html"))) << report.output;
}

TEST_F(InstallationTest, PythonCommandsFindTheirModules) {
  for (const std::string name : {"draw_report", "kitti_benchmark", "reset_sim_time", "rig_view"}) {
    const CommandResult help = run("rosrun rotrocc " + name + " --help");
    EXPECT_EQ(help.status, 0) << help.output;
  }
  // Without the environment of ROS: from the devel space, and from a checkout.
  for (const std::string folder : {BUILD "/devel/lib/rotrocc", SOURCE "/scripts"}) {
    const CommandResult help = runCommand("env -i PATH=/usr/bin " + folder + "/draw_report --help");
    EXPECT_EQ(help.status, 0) << help.output;
  }
  // One of the modules is a program.
  writeSyntheticSequence(path("one"), 3);
  const CommandResult one =
      run("rosrun rotrocc kitti_benchmark " + path("one") + " --output " + path("benchmark"));
  EXPECT_EQ(one.status, 0) << one.output;
}

TEST_F(InstallationTest, SetupBashMakesItKnown) {
  const CommandResult result = runCommand(
      "unset ROS_PACKAGE_PATH CMAKE_PREFIX_PATH LD_LIBRARY_PATH PYTHONPATH; bash -c '. " +
      prefix() + "/setup.bash && rosrun rotrocc check_rig --help >/dev/null && " +
      "rosmsg show rotrocc/DropCount && rospack find rotrocc'");
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find(prefix() + "/share/rotrocc\n"), std::string::npos) << result.output;
}

TEST_F(InstallationTest, LaunchFilesNameInstalledNodes) {
  const CommandResult result = run("roslaunch --nodes rotrocc replay.launch bag:=any.bag");
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find("/stereo/stereo_odometry"), std::string::npos) << result.output;
}

TEST_F(InstallationTest, PluginsAreWhereTheDescriptionSays) {
  const CommandResult result =
      run("cd " + prefix() + "/share/rotrocc && ls $(sed -n 's/.*path=\"\\([^\"]*\\).*/\\1.so/p' " +
          "nodelet_plugins.xml)");
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find("stereo_odometry"), std::string::npos) << result.output;
}

/// The code of a page, by its language.
std::string exampleOf(const std::string& language) {
  const std::string page = readFile(SOURCE "/docs/library.md");
  const std::string mark = "```" + language + "\n";
  const std::size_t begin = page.find(mark) + mark.size();
  return page.substr(begin, page.find("```", begin) - begin);
}

TEST_F(InstallationTest, TheExampleOfTheLibraryIsBuiltAgainstIt) {
  std::filesystem::create_directory(path("user"));
  writeSyntheticSequence(path("input"), 3);
  std::ofstream(path("user/CMakeLists.txt")) << exampleOf("cmake");
  std::ofstream(path("user/example.cpp")) << exampleOf("cpp");
  const CommandResult built =
      run("cmake -S " + path("user") + " -B " + path("user/build") +
          " -DPYTHON_EXECUTABLE=/usr/bin/python3 && cmake --build " + path("user/build"));
  ASSERT_EQ(built.status, 0) << built.output;
  const CommandResult result = run(path("user/build/example") + " " + path("input"));
  EXPECT_EQ(result.output.find("initializing 0 0 0\nok "), 0u) << result.output;
  EXPECT_TRUE(std::regex_search(result.output, std::regex("\\nok [^\n]*\nok "))) << result.output;
}

TEST_F(InstallationTest, TheExampleInPythonListensToTheNode) {
  writeSyntheticSequence(path("drive"), 20);
  std::ofstream(path("listener.py")) << exampleOf("python");
  const CommandResult result = run(
      "port=$(python3 -c 'import socket; s = socket.socket(); s.bind((\"\", 0)); "
      "print(s.getsockname()[1])'); export ROS_MASTER_URI=http://localhost:$port; "
      "roscore -p $port >/dev/null 2>&1 & master=$!; "
      "until rosparam list >/dev/null 2>&1; do sleep 0.2; done; python3 " +
      path("listener.py") + " odom:=/stereo/odom status:=/stereo/status > " + path("heard.txt") +
      " & listener=$!; roslaunch rotrocc replay.launch rviz:=false bag:=" + path("drive") +
      "; kill $listener $master; wait");
  const std::string heard = readFile(path("heard.txt"));
  EXPECT_TRUE(
      std::regex_search(heard, std::regex(R"(\d s: -?\d+\.\d\d -?\d+\.\d\d -?\d+\.\d\d m\n)")))
      << heard << result.output;
}

TEST(ConfigurationTest, APythonWithoutRosIsNotUsed) {
  const TemporaryDirectory directory;
  const std::string python = directory.write("python3", "#!/bin/sh\nexit 1\n");
  std::filesystem::permissions(python, std::filesystem::perms::owner_all);
  // As it is first in PATH, an earlier run has stored it.
  const CommandResult result =
      runCommand("PATH=" + directory / "" + ":$PATH cmake -S " SOURCE " -B " + directory / "build" +
                 " -DCATKIN_ENABLE_TESTING=OFF -DPYTHON_EXECUTABLE=" + python);
  EXPECT_EQ(result.status, 0) << result.output;
}

}  // namespace
}  // namespace rotrocc
