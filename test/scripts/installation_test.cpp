// Installs the build into a prefix of its own, and uses it as one who has no sources.

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>

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
  const CommandResult result = run("roslaunch --nodes rotrocc kitti.launch bag:=any.bag");
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

TEST_F(InstallationTest, ProgramsAreBuiltAgainstIt) {
  std::filesystem::create_directory(path("user"));
  writeSyntheticSequence(path("input"), 3);
  std::ofstream(path("user/CMakeLists.txt"))
      << "cmake_minimum_required(VERSION 3.16)\n"
         "project(user CXX)\n"
         "set(CMAKE_CXX_STANDARD 17)\n"
         "find_package(rotrocc REQUIRED)\n"
         "include_directories(${rotrocc_INCLUDE_DIRS})\n"
         "add_executable(user user.cpp)\n"
         "target_link_libraries(user ${rotrocc_LIBRARIES} opencv_imgcodecs)\n";
  std::ofstream(path("user/user.cpp"))
      << "#include <iostream>\n"
         "#include <opencv2/imgcodecs.hpp>\n"
         "#include <rotrocc/visual_odometry.h>\n"
         "int main(int, char** argv) {\n"
         "  rotrocc::StereoCamera camera;\n"
         "  camera.width = 620, camera.height = 188, camera.fx = camera.fy = 360.0;\n"
         "  camera.cx = camera.cx_right = 305.0, camera.cy = 92.0, camera.baseline_m = 0.54;\n"
         "  rotrocc::VisualOdometry odometry({});\n"
         "  int found = 0;\n"
         "  for (int i = 0; i < 3; ++i) {\n"
         "    const auto read = [&](const char* side) {\n"
         "      const std::string name = cv::format(\"/image_%s/%06d.png\", side, i);\n"
         "      return cv::imread(argv[1] + name, cv::IMREAD_GRAYSCALE);\n"
         "    };\n"
         "    const rotrocc::StereoPair pair = {100000000LL * i, read(\"0\"), read(\"1\")};\n"
         "    found += odometry.process(pair, camera).hasMotion();\n"
         "  }\n"
         "  std::cout << \"motions: \" << found;\n"
         "}\n";
  const CommandResult built =
      run("cmake -S " + path("user") + " -B " + path("user/build") +
          " -DPYTHON_EXECUTABLE=/usr/bin/python3 && cmake --build " + path("user/build"));
  ASSERT_EQ(built.status, 0) << built.output;
  const CommandResult result = run(path("user/build/user") + " " + path("input"));
  EXPECT_EQ(result.output, "motions: 2");
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
