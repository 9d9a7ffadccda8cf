// Runs scripts/realism in its short form, with a rendered drive in place of a real clip.

#include <gtest/gtest.h>

#include "rotrocc/trajectory.h"
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

TEST_F(RealismTest, ScoresEachSettingOnTwinsAndClips) {
  const std::vector<CsvRow> rows = readTable("realism");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[2].at("setting"), "one stage");
  double twins = 0.0;
  double real = 0.0;
  for (const CsvRow& row : rows) {
    for (const char* column : {"twins translation [%]", "real translation [%]"}) {
      EXPECT_GT(number(row, column), 0.0) << column;
      EXPECT_LT(number(row, column), 10.0) << column;
    }
    twins += number(row, "twins translation [%]");
    real += number(row, "real translation [%]");
  }
  // The twin has a worn rig, the clip a perfect one. On so few pairs a single setting can be lucky.
  EXPECT_GT(twins, real);
}

/// The motion of the clip, through another street. Files of poses have 12 digits.
TEST_F(RealismTest, TwinsHaveThePosesOfTheirClip) {
  const Trajectory clip = readTrajectory(directory() / "clip/poses.txt");
  const Trajectory twin = readTrajectory(outputPath("drives/clip_worn_1_12_0.0/poses.txt"));
  ASSERT_EQ(twin.size(), 12u);
  for (std::size_t i = 0; i < twin.size(); ++i) {
    EXPECT_TRUE(twin[i].T_world_body.isApprox(clip[i].T_world_body, 1e-9)) << i;
  }
}

TEST_F(RealismTest, WritesTheErrorsOfEachDrive) {
  const std::vector<CsvRow> rows = readTable("errors");
  ASSERT_EQ(rows.size(), 12u);
  EXPECT_EQ(rows[0].at("drive"), "clip_worn_1_12_0.0");
  EXPECT_EQ(number(rows[0], "every"), 1.0);
  EXPECT_EQ(rows[11].at("drive"), "clip");
  EXPECT_EQ(number(rows[11], "every"), 2.0);
  EXPECT_GT(number(rows[11], "rotation_deg_per_m"), 0.0);
}

}  // namespace
}  // namespace rotrocc
