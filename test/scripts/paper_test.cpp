// Runs experiments/paper in its short form, and checks its results.

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/read_file.h"
#include "support/script_test.h"
#include "support/slow_build.h"

namespace rotrocc {
namespace {

class PaperTest : public ScriptTest {
 protected:
  static void SetUpTestSuite() {
    runScript(PAPER, isSlowBuild() ? "--short --scenarios motorway --frames 12" : "--short");
  }

  static std::vector<std::string> drives() {
    if (isSlowBuild()) return {"motorway"};
    return {"motorway", "slip_road"};
  }
  static int steps() { return isSlowBuild() ? 11 : 39; }
};

TEST_F(PaperTest, DrawsAllFigures) {
  for (const std::string name : {"fig5", "fig7", "fig8"}) {
    const std::string picture = readFile(outputPath(name) + ".png");
    EXPECT_EQ(picture.substr(0, 4), "\x89PNG") << name;
    EXPECT_GT(picture.size(), 10000u) << name << " is next to empty";
  }
}

TEST_F(PaperTest, NormalizedErrorsLieAtATenthInSingleAxisMotions) {
  std::map<std::string, int> features;
  for (const CsvRow& row : readTable("fig4")) {
    ++features[row.at("motion")];
    if (number(row, "depth_m") < 6.04) continue;  // where the bound of the paper holds, by Eq. 17
    EXPECT_NEAR(number(row, "nre"), 0.1, 0.0154) << row.at("motion");
  }
  EXPECT_EQ(features.size(), 6u);
  EXPECT_GT(features["t_z"], 300);  // half of those that are asked for
}

TEST_F(PaperTest, OnlyTheDecoupledErrorTellsWrongDepths) {
  std::map<bool, int> count;
  double least_wrong = 1.0, greatest_right = 0.0, least_wrong_nre = 1.0, greatest_right_nre = 0.0;
  for (const CsvRow& row : readTable("fig5")) {
    const bool right = number(row, "depth_factor") == 1.0;
    ++count[right];
    if (right) {
      EXPECT_LT(number(row, "dnre"), 0.0505);  // the translation is 5 % too long
      greatest_right = std::max(greatest_right, number(row, "dnre"));
      greatest_right_nre = std::max(greatest_right_nre, number(row, "nre"));
    } else {
      least_wrong = std::min(least_wrong, number(row, "dnre"));
      least_wrong_nre = std::min(least_wrong_nre, number(row, "nre"));
    }
  }
  EXPECT_EQ(count[false], 5);
  EXPECT_GT(least_wrong, 1.5 * greatest_right);
  EXPECT_LT(least_wrong_nre, greatest_right_nre);
}

TEST_F(PaperTest, EveryCriterionFollowsTheDrives) {
  for (const std::string& drive : drives()) {
    const std::vector<CsvRow> frames = readTable("fig6_" + drive);
    EXPECT_EQ(frames.size(), static_cast<std::size_t>(steps()));
    double squares = 0.0;
    for (const CsvRow& frame : frames) {
      squares += std::pow(number(frame, "rotrocc") - number(frame, "truth"), 2) / steps();
    }
    EXPECT_LT(std::sqrt(squares), 0.015) << drive;  // [m]; the steps are 1 and 2.5 m
  }
  for (const CsvRow& row : readTable("summary")) {
    for (const std::string criterion : {"rotrocc", "reprojection", "rocc"}) {
      EXPECT_LT(number(row, criterion + "_translation_percent"), 1.0) << row.at("drive");
      EXPECT_LT(number(row, criterion + "_rotation_deg_per_m"), 0.005) << row.at("drive");
    }
  }
}

TEST_F(PaperTest, ErrorsBySpeedAndLengthHaveBothCriteria) {
  for (const std::string figure : {"fig7", "fig8"}) {
    for (const std::string column : {"speed_mps", "length_m"}) {
      std::map<std::string, int> rows;
      for (const CsvRow& row : readTable(figure + "_" + column)) {
        ++rows[row.at("criterion")];
        EXPECT_GT(number(row, "segments"), 0.0);
      }
      EXPECT_EQ(rows.size(), 2u) << figure;
      EXPECT_GE(rows["rotrocc"], 2) << figure << " by " << column;
    }
  }
}

}  // namespace
}  // namespace rotrocc
