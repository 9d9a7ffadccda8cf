// Runs scripts/real_clips in its short form, with a rendered drive in place of a real clip.

#include <gtest/gtest.h>

#include "support/script_test.h"

namespace rotrocc {
namespace {

constexpr int kPairs = 24;

class RealClipsTest : public ScriptTest {
 protected:
  static void SetUpTestSuite() {
    const CommandResult rendered = runCommand(std::string(PROGRAMS) + "/simulate_drive slip_road " +
                                              clip() + " --frames " + std::to_string(kPairs));
    ASSERT_EQ(rendered.status, 0) << rendered.output;
    runScript(REAL_CLIPS,
              clip() + ":5,10 --set systematic_error/translation_share=0" +
                  " --set systematic_error/rotation_share=0");
  }
  static std::string clip() { return directory() / "clip"; }

  /// The row of a run with other right images.
  static CsvRow withRight(const std::string& gain_and_offset) {
    const std::string output = directory() / "changed";
    const CommandResult result =
        runCommand(std::string(PYTHON) + " " + REAL_CLIPS + " " + clip() + ":5,10 --programs " +
                   PROGRAMS + " --output " + output + " --every 1 --right " + gain_and_offset);
    EXPECT_EQ(result.status, 0) << result.output;
    return readCsv(output + "/real_clips.csv").at(0);
  }
};

TEST_F(RealClipsTest, MeasuresEachPairAndEachSecondPair) {
  const std::vector<CsvRow> rows = readTable("real_clips");
  ASSERT_EQ(rows.size(), 2u);
  for (const CsvRow& row : rows) {
    EXPECT_EQ(row.at("clip"), "clip");
    EXPECT_EQ(number(row, "pairs"), kPairs / number(row, "every"));
    EXPECT_EQ(number(row, "lost"), 0.0);
    EXPECT_GT(number(row, "translation_percent"), 0.0);
    EXPECT_LT(number(row, "translation_percent"), 1.0);  // measured: 0.07, 0.18
    EXPECT_GT(number(row, "depths"), 100.0);
    EXPECT_GT(number(row, "nees_mean"), 1.0);
    EXPECT_LT(number(row, "nees_mean"), 20.0);  // 6 is expected
  }
}

/// Of one clip, the geometric means are its errors.
TEST_F(RealClipsTest, GivesTheMeansOverTheClips) {
  const std::vector<CsvRow> rows = readTable("real_clips");
  const std::vector<CsvRow> means = readTable("means");
  ASSERT_EQ(means.size(), rows.size());
  for (std::size_t i = 0; i < means.size(); ++i) {
    EXPECT_EQ(means[i].at("every"), rows[i].at("every"));
    EXPECT_NEAR(
        number(means[i], "rotation_deg_per_m"), number(rows[i], "rotation_deg_per_m"), 1e-9);
  }
}

TEST_F(RealClipsTest, ChangesTheRightImages) {
  const CsvRow row = withRight("0.8 20");
  EXPECT_EQ(number(row, "lost"), 0.0);
  EXPECT_LT(number(row, "translation_percent"), 1.0);
  EXPECT_NE(row.at("translation_percent"), readTable("real_clips")[0].at("translation_percent"));
}

TEST_F(RealClipsTest, SaysIfAllPairsAreLost) {
  const CsvRow row = withRight("0 50");
  EXPECT_EQ(number(row, "depths"), 0.0) << "nothing is seen in grey";
  EXPECT_EQ(number(row, "lost"), kPairs - 1.0);
}

}  // namespace
}  // namespace rotrocc
