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

TEST(RowComparisonTest, KnowsNothingWithoutFeatures) {
  RowComparison comparison;
  comparison.observe({});
  EXPECT_EQ(comparison.offset().median_px, 0.0);
  EXPECT_EQ(comparison.offset().typical_px, 0.0);
}

TEST(RowComparisonTest, FindsTheOffsetInSpiteOfWrongFeatures) {
  RowComparison comparison;
  show(1000, -0.35, 0.2, comparison);
  const RowOffset& offset = comparison.offset();
  // The outliers shift the median by 0.18 standard deviations of the noise.
  EXPECT_NEAR(offset.median_px, -0.35 + 0.18 * 0.2, 0.02);
  EXPECT_NEAR(offset.typical_px, 0.35, 0.05);
  // 1.25 * 0.2 / sqrt(1000), increased by the outliers.
  EXPECT_NEAR(offset.sigma_px, 0.008, 0.002);
}

TEST(RowComparisonTest, RowsThatDifferBothWaysAreApart) {
  RowComparison comparison;
  for (int i = 0; i < 100; ++i) comparison.observe({-0.8F, 0.8F, -0.8F, 0.8F, 0.0F});
  EXPECT_NEAR(comparison.offset().median_px, 0.0, 1e-6);
  EXPECT_NEAR(comparison.offset().typical_px, 0.8, 1e-6);
}

TEST(RowComparisonTest, ForgetsWhatIsLongAgo) {
  RowComparison comparison;
  show(4000, 1.0, 0.1, comparison);
  show(1000, -0.5, 0.1, comparison);
  EXPECT_NEAR(comparison.offset().median_px, -0.5, 0.05);
  comparison.reset();
  EXPECT_EQ(comparison.offset().median_px, 0.0);
  show(100, 0.25, 0.1, comparison);
  EXPECT_NEAR(comparison.offset().median_px, 0.25, 0.1);
}

}  // namespace
}  // namespace rotrocc
