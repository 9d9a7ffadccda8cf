// Runs scripts/realism in its short form, with a rendered drive in place of a real clip.

#include <gtest/gtest.h>

#include "support/script_test.h"

namespace rotrocc {
namespace {

class RealismTest : public ScriptTest {
 protected:
  static void SetUpTestSuite() {
    const std::string clip = directory() / "clip";
    const CommandResult rendered = runCommand(std::string(PROGRAMS) + "/simulate_drive slip_road " +
                                              clip + " --seed 2 --frames 12");
    ASSERT_EQ(rendered.status, 0) << rendered.output;
    runScript(REALISM, clip);
  }
};

TEST_F(RealismTest, ScoresEachSettingOnDrivesAndClips) {
  const std::vector<CsvRow> rows = readTable("realism");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[2].at("setting"), "reprojection");
  double simulated = 0.0;
  double real = 0.0;
  for (const CsvRow& row : rows) {
    for (const char* column : {"simulated translation [%]", "real translation [%]"}) {
      EXPECT_GT(number(row, column), 0.0) << column;
      EXPECT_LT(number(row, column), 10.0) << column;
    }
    simulated += number(row, "simulated translation [%]");
    real += number(row, "real translation [%]");
  }
  // The drive has a worn rig, the clip a perfect one. On so few pairs a single setting can be
  // lucky.
  EXPECT_GT(simulated, real);
}

TEST_F(RealismTest, WritesTheErrorsOfEachDrive) {
  const std::vector<CsvRow> rows = readTable("errors");
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[0].at("drive"), "slip_road_worn_1_12");
  EXPECT_EQ(rows[5].at("drive"), "clip");
  EXPECT_GT(number(rows[5], "rotation_deg_per_m"), 0.0);
}

}  // namespace
}  // namespace rotrocc
