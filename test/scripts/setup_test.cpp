// The lists of dependencies, and scripts/setup with stand-ins for dpkg-query, apt and id, so that
// nothing is installed.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "support/read_file.h"
#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

const std::string kSetup = ROOT "/scripts/setup";
const std::string kControl = ROOT "/packaging/debian/control";
const std::string kPackageXml = ROOT "/package.xml";

class SetupTest : public ::testing::Test {
 protected:
  SetupTest() {
    // All that setup may name, without the packages of missing.txt.
    command("dpkg-query",
            "cat " + kSetup + " " + kControl +
                " | grep -o -E '[a-z0-9.+-]+' | sort -u |\n"
                "  grep -v -x -F -f " +
                directory_ / "missing.txt" + " | sed 's/.*/|installed|&|/'");
    command("id", "echo 0");
    setUpApt();
  }

  /// No package is missing, and apt has all packages.
  void setUpApt() const {
    setMissing("");
    command("apt-cache", "echo '  Candidate: 1.0'");
    command("apt-get",
            "echo \"$@\" >>" + directory_ / "apt.txt" +
                "\n[ \"$1\" != install ] || echo 'Need to get 5 MB of archives.'");
    std::filesystem::remove(directory_ / "apt.txt");
  }

  void command(const std::string& name, const std::string& body) const {
    const std::string path = directory_.write(name, "#!/bin/sh\n" + body + "\n");
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  }

  void setMissing(const std::string& packages) const { directory_.write("missing.txt", packages); }

  CommandResult setup(const std::string& arguments = "", const std::string& script = kSetup) const {
    return runCommand("PATH=" + directory_ / "" + ":/usr/bin:/bin " + script + " " + arguments +
                      " </dev/null");
  }

  /// With a terminal, on which the user types an answer.
  CommandResult setupOnTerminal(const std::string& answer) const {
    return runCommand("echo " + answer + " | PATH=" + directory_ / "" +
                      ":/usr/bin:/bin script -qec " + kSetup + " /dev/null");
  }

  std::string aptCalls() const {
    std::ifstream file(directory_ / "apt.txt");
    return {std::istreambuf_iterator<char>(file), {}};
  }

  TemporaryDirectory directory_;
};

TEST_F(SetupTest, InstallsWhatIsMissingOrSaysForWhat) {
  const std::string kNoNetwork = "exit 100", kUnknown = "echo '  Candidate: (none)'";
  const struct {
    std::string missing, further;
    std::string apt, answer;  // a command of apt, and what it does instead
    int status;
    std::string printed, called;
  } rows[] = {
      {"", "", "", "", 0, "packages are installed", ""},
      {"g++", "", "", "", 0, "to install: g++\nNeed to get 5 MB", "-y -qq g++"},
      {"an-example", "an-example", "", "", 0, "done", "-y -qq an-example"},
      {"clang-format", "", "apt-get", kNoNetwork, 0, "for the linters: clang-format", ""},
      {"parallel", "", "apt-get", kNoNetwork, 0, "reports, rviz and tools of ROS: parallel", ""},
      {"g++", "", "apt-get", kNoNetwork, 1, "for building and running: g++", ""},
      {"g++", "", "apt-cache", kUnknown, 1, "apt knows no package g++", "update"}};
  for (const auto& row : rows) {
    setUpApt();
    setMissing(row.missing + "\n");
    if (!row.apt.empty()) command(row.apt, row.answer);
    const CommandResult result = setup(row.further);
    EXPECT_EQ(result.status, row.status) << row.printed << ": " << result.output;
    EXPECT_NE(result.output.find(row.printed), std::string::npos) << result.output;
    if (row.called.empty()) {
      EXPECT_EQ(aptCalls(), "") << row.printed;
    } else {
      EXPECT_NE(aptCalls().find(row.called), std::string::npos) << aptCalls();
    }
  }
}

TEST_F(SetupTest, AsksOnATerminal) {
  if (runCommand("script -qec true /dev/null").status != 0) {
    GTEST_SKIP() << "needs a pseudo-terminal: mount /dev/pts";
  }
  setMissing("g++\n");
  const CommandResult rejected = setupOnTerminal("n");
  EXPECT_NE(rejected.status, 0) << rejected.output;
  EXPECT_EQ(aptCalls().find("-y -qq"), std::string::npos) << aptCalls();
  const CommandResult agreed = setupOnTerminal("y");
  EXPECT_EQ(agreed.status, 0) << agreed.output;
  EXPECT_NE(aptCalls().find("-y -qq g++"), std::string::npos) << aptCalls();
}

TEST_F(SetupTest, UbuntuGetsThePackagesOfNoetic) {
  for (const char* folder : {"scripts", "packaging/debian"}) {
    std::filesystem::create_directories(directory_ / folder);
  }
  std::filesystem::copy_file(kControl, directory_ / "packaging/debian/control");
  std::filesystem::copy_file(kPackageXml, directory_ / "package.xml");
  const std::string system = directory_.write("os-release", "ID=ubuntu\nVERSION_ID=20.04\n");
  const std::string script =
      std::regex_replace(readFile(kSetup), std::regex("/etc/os-release"), system);
  command("scripts/setup", script);
  command("dpkg-query", "echo '|installed|g++|'");
  const CommandResult result = setup("", "bash " + directory_ / "scripts/setup");
  EXPECT_EQ(result.status, 0) << result.output;
  for (const char* package : {"libeigen3-dev", "python3-yaml", "ros-noetic-tf2-ros", "parallel"}) {
    EXPECT_NE(aptCalls().find(std::string(" ") + package + " "), std::string::npos) << package;
  }
  EXPECT_EQ(aptCalls().find("python3-ros"), std::string::npos) << "Debian's and Noetic's conflict";
}

/// The first groups of all matches.
std::set<std::string> find(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match) {
    found.insert((*match)[1]);
  }
  return found;
}

/// What a Debian package or a key of package.xml is called without the parts of the one or the
/// other.
std::string bareName(const std::string& name) {
  static const std::map<std::string, std::string> kOthers = {
      {"boost", "boost-program-options"},
      {"eigen", "eigen3"},
      {"libdynamic-reconfigure-config-init-mutex-dev", "dynamic-reconfigure"},
      {"libnodeletlib-dev", "nodelet"},
      {"libnodeletlib-tools", "nodelet"}};
  const auto other = kOthers.find(name);
  if (other != kOthers.end()) return other->second;
  const std::string bare =
      std::regex_replace(name, std::regex("^(lib)?(ros-)?(python3-)?|-dev$"), "");
  return std::regex_replace(bare, std::regex("_"), "-");
}

std::set<std::string> bareNames(const std::set<std::string>& names) {
  std::set<std::string> bare;
  std::transform(names.begin(), names.end(), std::inserter(bare, bare.end()), bareName);
  return bare;
}

TEST(DependenciesTest, ThoseOfDebianAndOfPackageXmlAreTheSame) {
  std::string fields;
  const std::string control = std::regex_replace(readFile(kControl), std::regex("\n#[^\n]*"), "");
  for (const std::string& field :
       find(control, "\n((?:Build-Depends|Depends|Recommends):[^\n]*(?:\n [^\n]*)*)")) {
    fields += std::regex_replace(field, std::regex(R"(^[^:]*:|\([^)]*\)|<[^>]*>|\$\{[^}]*\})"), "");
  }
  std::set<std::string> debian = bareNames(find(fields, "([a-z][a-z0-9.+-]+)"));
  std::set<std::string> ros = bareNames(find(readFile(kPackageXml), "depend[^>]*>([^<]+)</"));
  // Of these, ROS has no keys; Debian has no package, or setup installs it for tests.
  for (const char* name :
       {"cmake", "debhelper-compat", "js-leaflet", "netbase", "parallel", "rotrocc"}) {
    EXPECT_EQ(debian.erase(name), 1u) << name;
  }
  for (const char* name : {"pil", "psutil", "robot-localization"}) {
    EXPECT_EQ(ros.erase(name), 1u) << name;
  }
  EXPECT_EQ(debian, ros);
}

TEST(DependenciesTest, HasTheLibrariesOfTheDesign) {
  const std::set<std::string> ros = find(readFile(kPackageXml), "<depend>([^<]+)</");
  for (const char* key : {"roscpp",
                          "tf2",
                          "libopencv-dev",
                          "eigen",
                          "libceres-dev",
                          "cv_bridge",
                          "image_transport"}) {
    EXPECT_EQ(ros.count(key), 1u) << key;
  }
}

TEST(DependenciesTest, ReportsCanBeDrawnButARobotNeedsNoRviz) {
  const std::set<std::string> keys =
      find(readFile(kPackageXml), "<(?:exec_)?depend[^>]*>([^<]+)</");
  EXPECT_EQ(keys.count("python3-matplotlib") + keys.count("python3-numpy"), 2u);
  EXPECT_EQ(keys.count("rviz"), 0u);
}

}  // namespace
}  // namespace rotrocc
