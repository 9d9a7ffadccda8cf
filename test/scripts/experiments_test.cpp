// Runs experiments/run on short drives.

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "support/read_file.h"
#include "support/script_test.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

constexpr int kPairs = 24;

class ExperimentsTest : public ScriptTest {
 protected:
  /// Simulated rigs have no systematic error.
  static constexpr const char* kSettings =
      "settings:\n"
      "  default: {systematic_error/scale_share: 0, systematic_error/axes_rad: 0, "
      "systematic_error/common_share: 0}\n";

  static void SetUpTestSuite() {
    const CommandResult rendered =
        runCommand(PROGRAMS + ("/simulate_drive " + drive()) + " " + clip());
    ASSERT_EQ(rendered.status, 0) << rendered.output;
    runScript(RUN,
              plan("every: [1, 2]\n" + (kSettings + std::string("  brighter: {right: [0.8, 20]}\n"
                                                                "  gray: {right: [0, 50]}\n"))) +
                  clip() + ":5,10");
  }

  static std::string drive() {
    return "slip_road --size 620x188 --focal 360 --frames " + std::to_string(kPairs);
  }
  static std::string clip() { return directory() / "clip"; }

  /// A settings file, as an argument.
  static std::string plan(const std::string& text) {
    return directory().write("plan.yaml", text) + " ";
  }

  /// A copy of the clip without its true poses.
  static std::string withoutPoses(const std::string& name) {
    fs::copy(clip(), directory() / name, fs::copy_options::recursive);
    fs::remove(directory() / name + "/poses.txt");
    return directory() / name;
  }

  static CsvRow row(const std::string& drive,
                    const std::string& setting = "default",
                    const std::string& every = "1") {
    for (const CsvRow& row : readTable("runs")) {
      if (row.at("drive") == drive && row.at("setting") == setting && row.at("every") == every) {
        return row;
      }
    }
    throw std::runtime_error("no run of " + drive + " with " + setting);
  }
};

TEST_F(ExperimentsTest, MeasuresEachPairAndEachSecondPair) {
  for (const char* every : {"1", "2"}) {
    const CsvRow run = row("clip", "default", every);
    EXPECT_EQ(number(run, "pairs"), kPairs / std::stod(every));
    EXPECT_EQ(number(run, "lost"), 0.0);
    EXPECT_GT(number(run, "translation_percent"), 0.0);
    EXPECT_LT(number(run, "translation_percent"), 1.0);
    EXPECT_LT(number(run, "rotation_deg_per_m"), 0.02);
    EXPECT_GT(number(run, "depths"), 100.0);
    EXPECT_GT(number(run, "nees"), 1.0);
    EXPECT_LT(number(run, "nees"), 20.0);  // 6 is expected
  }
}

TEST_F(ExperimentsTest, ChangesTheRightImages) {
  EXPECT_LT(number(row("clip", "brighter"), "translation_percent"), 1.0);
  EXPECT_NE(row("clip", "brighter").at("translation_percent"),
            row("clip").at("translation_percent"));
  EXPECT_EQ(number(row("clip", "gray"), "lost"), kPairs - 1.0) << "nothing is seen in gray";
}

/// Of one clip, the geometric means are its errors.
TEST_F(ExperimentsTest, PrintsTheMeansOfEachSetting) {
  char mean[64];
  std::snprintf(
      mean, sizeof(mean), "| default | %.3f ", number(row("clip"), "translation_percent"));
  EXPECT_NE(printed().find(mean), std::string::npos) << mean << printed();
  EXPECT_NE(printed().find("| 23 11 |"), std::string::npos) << "lost in gray: " << printed();
}

TEST_F(ExperimentsTest, TakesPositionsOfAnAntennaForTruth) {
  const std::string folder = withoutPoses("antenna");
  std::istringstream poses(readFile(clip() + "/poses.txt"));
  std::ofstream positions(folder + "/ins.txt");
  for (double p[12];;) {
    for (double& value : p) poses >> value;
    if (!poses) break;
    // Beside and behind the camera, in another frame.
    const double x = 0.5 * p[0] - p[2] + p[3], y = 0.5 * p[4] - p[6] + p[7];
    positions << "0 49 8 114 " << 0.5 * p[8] - p[10] + p[11] + 100.0 << ' ' << -x << ' ' << -y
              << '\n';
  }
  positions.close();
  const CommandResult result = run(RUN, plan(kSettings) + folder + " " + withoutPoses("unknown"));
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_GT(number(row("antenna"), "translation_percent"), 0.0);
  EXPECT_LT(number(row("antenna"), "translation_percent"), 0.3);
  EXPECT_NEAR(number(row("antenna"), "step_percent"), 0.0, 1.0);
  EXPECT_EQ(row("unknown").at("translation_percent"), "nan");
  EXPECT_EQ(row("unknown").at("lost"), "0");
}

TEST_F(ExperimentsTest, SimulatesAGyroscope) {
  const CommandResult result =
      run(RUN, plan(kSettings + std::string("  gyroscope: {imu: true}\n")) + clip());
  ASSERT_EQ(result.status, 0) << result.output;
  // Of 23 pairs, the first may have one more: its start is not a prediction.
  EXPECT_LE(number(row("clip", "gyroscope"), "tries"), number(row("clip"), "tries") + 0.05);
  EXPECT_EQ(number(row("clip", "gyroscope"), "lost"), 0.0);
}

TEST_F(ExperimentsTest, AllWritesItsTablesIntoPages) {
  const std::string page =
      "# Page\n\n<!-- begin published -->\n\n<!-- end -->\n\n<!-- begin presets -->\nold\n<!-- end "
      "-->\n\nrest\n";
  fs::create_directory(directory() / "pages");
  std::ofstream(directory() / "pages/page.md") << page;
  const std::string all = fs::path(RUN).parent_path() / "all";
  const CommandResult result = run(
      all,
      clip() + ":5,10 --poses " + clip() + " --only published --pages " + (directory() / "pages"));
  ASSERT_EQ(result.status, 0) << result.output;
  const std::string written = readFile(directory() / "pages/page.md");
  EXPECT_TRUE(std::regex_search(
      written,
      std::regex(R"(^# Page\n\n<!-- begin published -->\n\n\| translation \[%\] \| clip \|)")))
      << written;
  EXPECT_TRUE(std::regex_search(written, std::regex(R"(\n\| default \| \d?\.\d\d \| 0 \|)")))
      << written;
  EXPECT_NE(
      written.find("|\n\n<!-- end -->\n\n<!-- begin presets -->\nold\n<!-- end -->\n\nrest\n"),
      std::string::npos)
      << written;
}

TEST(SettingsFilesTest, HaveParametersThatThereAre) {
  static const std::regex parameter(R"((\w+)/(\w+):)");
  const YAML::Node defaults = YAML::LoadFile(CONFIG "/default.yaml");
  int count = 0;
  for (const fs::directory_entry& file : fs::directory_iterator(fs::path(RUN).parent_path())) {
    if (file.path().extension() != ".yaml") continue;
    const std::string text = readFile(file.path());
    for (std::sregex_iterator match(text.begin(), text.end(), parameter), end; match != end;
         ++match, ++count) {
      EXPECT_TRUE(defaults[match->str(1)] && defaults[match->str(1)][match->str(2)])
          << file.path() << ": " << match->str();
    }
  }
  EXPECT_GT(count, 5);
}

TEST_F(ExperimentsTest, RejectsAFileWithoutSettings) {
  const CommandResult result = run(RUN, plan("drives: {}") + clip());
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.output.find("plan.yaml has no settings"), std::string::npos) << result.output;
}

}  // namespace
}  // namespace rotrocc
