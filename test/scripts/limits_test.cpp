// Runs experiments/limits in its short form.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/read_file.h"
#include "support/script_test.h"

namespace rotrocc {
namespace {

class LimitsTest : public ScriptTest {
 protected:
  static void SetUpTestSuite() { runScript(LIMITS, "--short"); }
};

TEST_F(LimitsTest, FindsTheLimitsOfEachStress) {
  const std::vector<CsvRow> rows = readTable("limits");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].at("stress"), "roll");
  EXPECT_EQ(rows[1].at("stress"), "jpeg");
  for (const CsvRow& row : rows) EXPECT_EQ(row.at("config"), "default");
  // 2 deg a pair and a quality of 90 are not hard, 32 deg a pair and a quality of 1 too hard.
  EXPECT_GE(number(rows[0], "fine_to"), 2.0);
  EXPECT_LT(number(rows[0], "fine_to"), 32.0);
  EXPECT_LE(number(rows[1], "fine_to"), 90.0);
  EXPECT_GT(number(rows[1], "fine_to"), 1.0);
  EXPECT_NE(readFile(outputPath("limits.md")).find("| JPEG quality |  | 90 to 1 |"),
            std::string::npos);
  EXPECT_EQ(readFile(outputPath("limits.png")).substr(1, 3), "PNG");
}

/// What the zones are made of.
TEST_F(LimitsTest, ReportsEachRun) {
  for (const CsvRow& row : readTable("runs")) {
    const double with_state = number(row, "ok") + number(row, "degraded") + number(row, "lost");
    EXPECT_EQ(number(row, "pairs"), 8.0);
    EXPECT_EQ(with_state, 7.0) << "all but the first";
    EXPECT_LE(number(row, "wrong"), number(row, "wrong_by_distance"));
    EXPECT_EQ(number(row, "wrong") > 0, number(row, "largest_sigma") > 6.0);
  }
}

/// The same command measures nothing again.
TEST_F(LimitsTest, Resumes) {
  const std::string runs = readFile(outputPath("runs.csv"));
  EXPECT_EQ(run(LIMITS, "--short").status, 0);
  EXPECT_EQ(readFile(outputPath("runs.csv")), runs);
}

}  // namespace
}  // namespace rotrocc
