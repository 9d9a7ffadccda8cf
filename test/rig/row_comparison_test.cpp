#include "rig/row_comparison.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

/// Adds `features` features whose rows differ by `offset_px` and noise. One in eight is an outlier.
void show(int features, double offset_px, double noise_px, RowComparison& comparison) {
  std::mt19937 generator(1);
  std::normal_distribution<float> noise(static_cast<float>(offset_px),
                                        static_cast<float>(noise_px));
  std::vector<float> differences_px;
  for (int i = 0; i < features; ++i) {
    differences_px.push_back(i % 8 == 0 ? 5.0F : noise(generator));
    if (differences_px.size() < 50) continue;
    comparison.observe(differences_px);
    differences_px.clear();
  }
}

TEST(RowComparisonTest, FindsTheOffsetInSpiteOfWrongFeatures) {
  RowComparison comparison;
  show(1000, -0.35, 0.2, comparison);
  const RowOffset& offset = comparison.offset();
  // 1.25 * 0.2 / sqrt(875), of those that are no outliers.
  EXPECT_NEAR(offset.sigma_px, 0.0085, 0.001);
  EXPECT_NEAR(offset.median_px, -0.35, 0.0255) << "3 standard deviations";
  EXPECT_NEAR(offset.typical_px, 0.35, 0.05);
}

TEST(RowComparisonTest, ForgetsWhatIsLongAgo) {
  RowComparison comparison;
  show(4000, 1.0, 0.1, comparison);
  show(1000, -0.5, 0.1, comparison);
  EXPECT_NEAR(comparison.offset().median_px, -0.5, 0.05);
  comparison = {};
  EXPECT_EQ(comparison.offset().median_px, 0.0);
  show(100, 0.25, 0.1, comparison);
  EXPECT_NEAR(comparison.offset().median_px, 0.25, 0.1);
}

TEST(RowComparisonTest, CorrectsAnOffsetThatIsCertain) {
  RowComparison comparison;
  comparison.observe({});
  EXPECT_FALSE(comparison.isNear(0.0)) << "nothing is known";
  comparison.observe({-1.5F, -1.5F, -1.5F});
  EXPECT_FALSE(comparison.isKnown()) << "few may agree by chance";
  show(50, -1.5, 1.5, comparison);
  EXPECT_FALSE(comparison.isKnown()) << "3 * 1.25 * 1.5 / sqrt(50) px are more than half a row";
  EXPECT_FALSE(comparison.isNear(0.0));
  EXPECT_TRUE(comparison.isNear(-1.2));
  EXPECT_EQ(comparison.offset().applied_px, 0.0);
  show(200, -1.5, 0.2, comparison);
  EXPECT_TRUE(comparison.isKnown());
  EXPECT_EQ(comparison.offset().applied_px, comparison.offset().median_px);
  comparison = {};
  EXPECT_FALSE(comparison.isKnown());
  EXPECT_EQ(comparison.offset().applied_px, 0.0);
}

TEST(RowComparisonTest, CorrectionsDoNotComeAndGo) {
  RowComparison comparison;
  const auto appliedAt = [&](double offset_px) {
    show(2000, offset_px, 0.1, comparison);
    return comparison.offset().applied_px;
  };
  EXPECT_EQ(appliedAt(0.4), 0.0) << "less than half a row";
  EXPECT_NEAR(appliedAt(0.6), 0.6, 0.05);
  EXPECT_NEAR(appliedAt(0.4), 0.4, 0.05);
  EXPECT_EQ(appliedAt(0.15), 0.0);
  EXPECT_EQ(appliedAt(0.4), 0.0);
}

/// As those of a search in several rows: two thirds are anywhere.
TEST(RowComparisonTest, FindsTheOffsetAmongChanceMatches) {
  RowComparison comparison;
  std::mt19937 generator(1);
  std::uniform_real_distribution<float> anywhere(-4.0F, 4.0F);
  std::normal_distribution<float> near(3.5F, 0.2F);
  std::vector<float> differences_px;
  for (int i = 0; i < 300; ++i) {
    differences_px.push_back(i % 3 == 0 ? near(generator) : anywhere(generator));
  }
  comparison.observe(differences_px);
  EXPECT_TRUE(comparison.isKnown());
  // A fifth of what is kept is by chance.
  EXPECT_NEAR(comparison.offset().applied_px, 3.5, 0.1);
}

TEST(RowComparisonTest, ChanceMatchesAloneAreNoOffset) {
  RowComparison comparison;
  std::mt19937 generator(1);
  std::uniform_real_distribution<float> anywhere(-4.0F, 4.0F);
  for (int pair = 0; pair < 50; ++pair) {
    std::vector<float> differences_px(20);
    for (float& difference_px : differences_px) difference_px = anywhere(generator);
    comparison.observe(differences_px);
    EXPECT_EQ(comparison.offset().applied_px, 0.0) << pair;
  }
}

/// As with a right camera that is rolled and pitched.
TEST(RowComparisonTest, DoesNotCorrectWhatIsNoConstant) {
  RowComparison comparison;
  for (int i = 0; i < 100; ++i) comparison.observe({-2.5F, -0.8F, 0.8F, 2.4F, 4.0F});
  EXPECT_NEAR(comparison.offset().median_px, 0.8, 1e-6);
  EXPECT_EQ(comparison.offset().applied_px, 0.0);
}

TEST(RowComparisonTest, KeepsTheCorrectionUntilTheOffsetIsKnownAgain) {
  RowComparison comparison;
  show(1000, 1.5, 0.2, comparison);
  comparison.searchAgain();
  EXPECT_FALSE(comparison.isKnown());
  EXPECT_NEAR(comparison.offset().applied_px, 1.5, 0.1);
  comparison.observe({-2.0F, -2.0F, -2.0F});
  comparison.searchAgain();  // what is not known yet is not forgotten
  EXPECT_NEAR(comparison.offset().median_px, -2.0, 0.1);
  EXPECT_NEAR(comparison.offset().applied_px, 1.5, 0.1);
  show(50, -2.0, 0.2, comparison);
  EXPECT_NEAR(comparison.offset().applied_px, -2.0, 0.1);
}

}  // namespace
}  // namespace rotrocc
