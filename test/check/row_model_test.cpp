#include "check/row_model.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "check/windows.h"

namespace rotrocc {
namespace {

constexpr double kNoise_px = 0.1;
constexpr std::size_t kWindows = 10;

struct Rows {
  std::vector<RowSample> samples;
  std::vector<std::size_t> windows;
};

/// Rows by these causes, with noise, and one of twenty of a wrong match.
Rows rowsBy(const StereoCamera& camera, const RowCauses& causes, std::size_t count = 4000) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> x(0.0, camera.width), y(0.0, camera.height),
      wrong(-3.0, 3.0);
  Rows rows;
  for (std::size_t i = 0; i < count; ++i) {
    RowSample sample;
    sample.x_right = (x(generator) - camera.cx_right) / camera.fx;
    sample.y = (y(generator) - camera.cy) / camera.fy;
    sample.velocity_pxps = 50.0 * normal(generator);
    sample.row_px = rowOf(camera, causes, sample) + kNoise_px * normal(generator);
    if (i % 20 == 0) sample.row_px += wrong(generator);
    rows.samples.push_back(sample);
    rows.windows.push_back(i * kWindows / count);
  }
  return rows;
}

StereoCamera camera() {
  StereoCamera camera;
  camera.width = 752;
  camera.height = 480;
  camera.fx = camera.fy = 450.0;
  camera.cx = camera.cx_right = 375.5;
  camera.cy = 239.5;
  camera.baseline_m = 0.11;
  return camera;
}

TEST(RowModelTest, FindsEachCauseAlone) {
  const RowCauses values = {0.002, 0.004, -0.004, 0.004, 2.0, 0.01, 0.006};
  for (std::size_t k = 0; k < kRowCauses; ++k) {
    RowCauses truth = {};
    truth[k] = values[k];
    const Rows rows = rowsBy(camera(), truth);
    const RowModel model = fitRows(camera(), rows.samples, rows.windows, kWindows);
    EXPECT_GT(std::abs(model.causes[k]), 3.0 * model.sigmas[k]) << k;
    EXPECT_NEAR(model.causes[k], truth[k], 3.0 * model.sigmas[k]) << k;
    for (std::size_t other = 0; other < kRowCauses; ++other) {
      if (other == k) continue;
      EXPECT_NEAR(model.causes[other], 0.0, 4.0 * model.sigmas[other]) << k << other;
    }
  }
}

TEST(RowModelTest, FindsAllCausesAtOnce) {
  const RowCauses truth = {0.002, 0.004, -0.004, 0.004, 2.0, 0.01, 0.006};
  const Rows rows = rowsBy(camera(), truth);
  const RowModel model = fitRows(camera(), rows.samples, rows.windows, kWindows);
  for (std::size_t k = 0; k < kRowCauses; ++k) {
    EXPECT_NEAR(model.causes[k], truth[k], 4.0 * model.sigmas[k]) << k;
    EXPECT_GT(model.effects_px[k], 0.0) << k;
  }
}

/// In a narrow image a pitch and an offset look alike.
TEST(RowModelTest, SaysThatAnOffsetMayBeAPitch) {
  StereoCamera narrow = camera();
  narrow.fx = narrow.fy = 2000.0;
  RowCauses truth = {};
  truth[kOffset] = 0.7;
  const Rows rows = rowsBy(narrow, truth);
  const RowModel model = fitRows(narrow, rows.samples, rows.windows, kWindows);
  EXPECT_TRUE(model.may_be_pitch);
  EXPECT_NEAR(model.causes[kOffset], 0.7, 0.02);
  EXPECT_EQ(model.causes[kPitch], 0.0);
}

TEST(RowModelTest, AFewSamplesSayNothing) {
  const Rows rows = rowsBy(camera(), {0.002}, kLeastSamples - 1);
  const RowModel model = fitRows(camera(), rows.samples, rows.windows, kWindows);
  for (std::size_t k = 0; k < kRowCauses; ++k) {
    EXPECT_EQ(model.causes[k], 0.0);
    EXPECT_TRUE(std::isinf(model.sigmas[k]));
  }
}

TEST(RowModelTest, TheRotationIsThatOfTheRightCamera) {
  // A camera that looks to the right and higher: what is ahead is on its left, and lower.
  const Eigen::Vector3d ahead = rotationOf({0.0, 0.1, 0.1}).transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_LT(ahead.x(), -0.09);
  EXPECT_GT(ahead.y(), 0.09);
}

/// What changes slowly has a larger uncertainty than its values show one by one.
TEST(WindowsTest, CountWhatLasts) {
  const Windows windows(0.0, 100.0, 1000);
  ASSERT_EQ(windows.count(), 10u);
  std::vector<TimedValue> values;
  for (int i = 0; i < 1000; ++i) {
    const double time_s = 0.1 * i;
    values.push_back({time_s, std::fmod(std::floor(time_s / 10.0), 2.0)});
  }
  const Estimate estimate = overWindows(values, windows);
  EXPECT_NEAR(estimate.value, 0.5, 1e-9);
  EXPECT_NEAR(estimate.sigma, std::sqrt(0.25 / 9.0), 1e-9);
  EXPECT_TRUE(std::isnan(overWindows({}, windows).value));
  EXPECT_TRUE(std::isnan(overWindows({{1.0, 2.0}}, windows).sigma));
}

/// For a mean, the jackknife is the usual formula.
TEST(WindowsTest, TheJackknifeOfAMeanIsItsStandardError) {
  const std::vector<double> values = {1.0, 2.0, 4.0, 7.0};
  std::vector<std::vector<double>> without;
  for (const double left_out : values) without.push_back({(14.0 - left_out) / 3.0});
  EXPECT_NEAR(jackknifeSigmas(without)[0], std::sqrt(21.0 / 3.0 / 4.0), 1e-12);
}

TEST(WindowsTest, DigitsFollowTheUncertainty) {
  EXPECT_EQ(toText(Estimate{0.70234, 0.0081}, "px"), "0.7023 +- 0.0081 px");
  EXPECT_EQ(toText(Estimate{12.3, 4.2}, ""), "12.3 +- 4.2");
}

}  // namespace
}  // namespace rotrocc
