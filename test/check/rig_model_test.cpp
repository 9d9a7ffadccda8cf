#include "check/rig_model.h"

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "check/rig_sampler.h"
#include "check/windows.h"

namespace rotrocc {
namespace {

constexpr double kNoise_px = 0.1;
constexpr double kPeriod_s = 0.05;
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

/// Features of a scene from 1 to 10 m, between two pairs of cameras that advance and turn, by a rig
/// with these causes, with noise, and one of twenty of a wrong match. The motion that the odometry
/// has found is a little wrong.
PairSamples pairBy(const StereoCamera& camera,
                   const StereoCamera& assumed,
                   const RigCauses& causes,
                   std::mt19937& generator) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> x(0.0, camera.width), y(0.0, camera.height),
      inverse(0.1, 1.0), wrong(-3.0, 3.0);
  const auto small = [&](double size) -> Eigen::Vector3d {
    return size * Eigen::Vector3d(normal(generator), normal(generator), normal(generator));
  };
  OdometryResult result;
  result.stamp_ns = static_cast<std::int64_t>(1e9 * kPeriod_s);
  const auto poseOf = [](const Eigen::Vector3d& turn, const Eigen::Vector3d& move) {
    const Eigen::Quaterniond q(1.0, 0.5 * turn.x(), 0.5 * turn.y(), 0.5 * turn.z());
    return Eigen::Isometry3d(Eigen::Translation3d(move) * q.normalized());
  };
  const Eigen::Vector3d turn = small(0.02), move = Eigen::Vector3d(0.0, 0.0, 0.05) + small(0.02);
  const Eigen::Isometry3d T = poseOf(turn, move);
  result.T_keyframe_cur.T = poseOf(turn + small(1e-4), move + small(2e-4));
  PairSamples pair = {0.0, kNoise_px, 0.0, {}};
  const RigDisplacement displacement(camera, causes);
  for (int i = 0; i < 60; ++i) {
    Correspondence feature;
    feature.cur_px = {x(generator), y(generator)};
    const Eigen::Vector3d point = camera.ray(feature.cur_px) / inverse(generator);
    RigSample sample;
    const double disparity_px = camera.disparity(point.z());
    sample.x_right = (feature.cur_px.x() - disparity_px - camera.cx_right) / camera.fx;
    sample.y = (feature.cur_px.y() - camera.cy) / camera.fy;
    feature.keyframe_px = camera.project(T * point);
    const Eigen::Vector3d right(camera.baseline_m, 0.0, 0.0);
    sample.velocity_pxps =
        (camera.project(point - right) - camera.project(T * point - right)) / kPeriod_s;
    sample.left_px =
        cv::Point2f(static_cast<float>(feature.cur_px.x()), static_cast<float>(feature.cur_px.y()));
    Eigen::Vector2d displaced_px(0.0, 0.0);
    const double straight = sample.x_right;
    for (int step = 0; step < 10; ++step) {  // it depends on where the feature is seen
      displaced_px = displacement.of(sample);
      sample.x_right = straight + displaced_px.x() / camera.fx;
    }
    feature.keyframe_px += kNoise_px * Eigen::Vector2d(normal(generator), normal(generator));
    feature.disparity_px = disparity_px - displaced_px.x() + kNoise_px * normal(generator);
    sample.x_right = (feature.cur_px.x() - feature.disparity_px - assumed.cx_right) / assumed.fx;
    measureFlow(assumed, result, feature, sample);
    sample.row_px = displaced_px.y() + kNoise_px * normal(generator);
    if (i % 20 == 0) sample.row_px += wrong(generator);
    pair.samples.push_back(sample);
  }
  return pair;
}

constexpr int kPairs = 100;

/// Of a rig that is assumed to have principal points `left_px` further left than they are.
RigModel modelOf(const StereoCamera& camera,
                 const RigCauses& causes,
                 int pairs = kPairs,
                 double left_px = 0.0) {
  StereoCamera assumed = camera;
  assumed.cx -= left_px;
  assumed.cx_right -= left_px;
  std::mt19937 generator(1);
  std::vector<PairSamples> samples;
  for (int i = 0; i < pairs; ++i) {
    samples.push_back(pairBy(camera, assumed, causes, generator));
    samples.back().time_s = i;
  }
  return fitRig(assumed, samples, Windows(pairs, static_cast<std::size_t>(pairs)));
}

/// A bad calibration, in the order of RigCause.
constexpr RigCauses kBad = {
    0.004, 0.004, -0.006, 0.004, 2.0, 0.01, 0.003, 1.0, 0.004, 0.0, 0.0, 0.0};

/// Deviations are of eight parts of the image, with which a hundred values of five are one or none.
constexpr double kSigmas = 5.0;

TEST(RigModelTest, FindsEachCauseAlone) {
  for (std::size_t k = 0; k < kBothLenses; ++k) {
    RigCauses truth = {};
    truth[k] = kBad[k];
    const RigModel model = modelOf(camera(), truth);
    SCOPED_TRACE(k);
    EXPECT_GT(std::abs(model.causes[k]), 3.0 * model.sigmas[k]);
    EXPECT_NEAR(model.causes[k], truth[k], kSigmas * model.sigmas[k]);
    for (std::size_t other = 0; other < kRigCauses; ++other) {
      if (other == k) continue;
      EXPECT_NEAR(model.causes[other], 0.0, kSigmas * model.sigmas[other]) << other;
    }
  }
}

TEST(RigModelTest, FindsPrincipalPointsThatBothHaveWrong) {
  constexpr double kShift_px = 30.0;
  const RigModel model = modelOf(camera(), {}, kPairs, kShift_px);
  EXPECT_NEAR(model.values[kBothX], kShift_px, kSigmas * model.sigmas[kBothX]);
  EXPECT_TRUE(model.exceeds(1.0, kBothX));
  EXPECT_EQ(model.values[kBothY], 0.0);
  EXPECT_EQ(model.correctable, RigCauses{});
}

TEST(RigModelTest, FindsSeveralCausesAtOnce) {
  RigCauses truth = kBad;
  truth[kOffset] = truth[kBias] = truth[kTwist] = 0.0;
  const RigModel model = modelOf(camera(), truth);
  EXPECT_EQ(model.vertical, TurnOrShift::kTurn);
  EXPECT_EQ(model.horizontal, TurnOrShift::kTurn);
  // Derivatives by one cause are those without the others: a hundredth for angles like these.
  constexpr double kSecondOrder = 0.05;
  for (std::size_t k = 0; k < kRigCauses; ++k) {
    EXPECT_NEAR(
        model.causes[k], truth[k], kSigmas * model.sigmas[k] + kSecondOrder * std::abs(truth[k]))
        << k;
  }
}

TEST(RigModelTest, RowsAreThoseOfTheDetail) {
  RigCauses truth = {};
  truth[kOffset] = 0.6;
  StereoCamera sharp = camera(), soft = camera();
  soft.detail_px = 2.0;
  EXPECT_TRUE(modelOf(sharp, truth).exceeds(1.0, kOffset));
  EXPECT_FALSE(modelOf(soft, truth).exceeds(1.0, kOffset)) << "a third of a row";
}

/// In a narrow image a pitch and an offset look alike.
TEST(RigModelTest, SaysThatAnOffsetMayBeAPitch) {
  StereoCamera narrow = camera();
  narrow.fx = narrow.fy = 2000.0;
  RigCauses truth = {};
  truth[kOffset] = 0.7;
  const RigModel model = modelOf(narrow, truth);
  EXPECT_EQ(model.vertical, TurnOrShift::kEither);
  EXPECT_NEAR(model.causes[kOffset], 0.7, kSigmas * model.sigmas[kOffset]);
  EXPECT_EQ(model.causes[kPitch], 0.0);
}

/// What a calibration corrects fits windows better that it is not from; noise does not.
TEST(RigModelTest, KnowsWhetherACorrectionRepeatsItself) {
  RigCauses rolled = {};
  rolled[kRoll] = kBad[kRoll];
  const RigModel bad = modelOf(camera(), rolled);
  EXPECT_GT(bad.rows_gain.value, 10.0 * bad.rows_gain.sigma);
  EXPECT_NE(bad.correctable[kRoll], 0.0);
  const RigModel good = modelOf(camera(), {});
  EXPECT_EQ(good.correctable, RigCauses{});
  EXPECT_EQ(good.rows_gain.value, 0.0);
}

/// A value that is not significant is zero, but not more certain than a smaller one would be.
TEST(RigModelTest, WhatIsLeftOutIsUncertain) {
  constexpr int kFew = 5;  // pairs
  const RigModel few = modelOf(camera(), {}, kFew), many = modelOf(camera(), {});
  for (std::size_t k = 0; k < kRigCauses; ++k) {
    const auto cause = static_cast<RigCause>(k);
    SCOPED_TRACE(k);
    EXPECT_EQ(few.severity(cause).value, 0.0);
    EXPECT_GT(few.severity(cause).sigma, many.severity(cause).sigma);
    EXPECT_GT(many.severity(cause).sigma, 0.0);
  }
}

TEST(RigModelTest, AFewSamplesSayNothing) {
  const RigModel model = modelOf(camera(), {0.004}, 1);
  for (std::size_t k = 0; k < kRigCauses; ++k) {
    EXPECT_EQ(model.causes[k], 0.0);
    EXPECT_TRUE(std::isinf(model.sigmas[k]));
  }
}

TEST(RigModelTest, TheRotationIsThatOfTheRightCamera) {
  // A camera that looks to the right and higher: what is ahead is on its left, and lower.
  const Eigen::Vector3d ahead = rotationOf({0.0, 0.1, 0.1}).transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_LT(ahead.x(), -0.09);
  EXPECT_GT(ahead.y(), 0.09);
}

/// What changes slowly has a larger uncertainty than its values show one by one.
TEST(WindowsTest, CountWhatLasts) {
  const Windows windows(100.0, 1000);
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

TEST(WindowsTest, ScatterIsWhatTheUncertaintyDoesNotExplain) {
  const std::vector<Estimate> constant = {{0.1, 0.1}, {-0.1, 0.1}, {0.0, 0.1}, {-1.0, 1.0}};
  EXPECT_LT(scatterBeyondNoise(constant).value, 0.1);
  const std::vector<Estimate> moving = {{2.0, 0.1}, {-2.0, 0.1}, {2.0, 0.1}, {-2.0, 0.1}};
  EXPECT_NEAR(scatterBeyondNoise(moving).value, std::sqrt(16.0 / 3.0), 0.01);
  EXPECT_NEAR(scatterBeyondNoise(moving).sigma, 0.1 / std::sqrt(3.0), 0.001);
  EXPECT_TRUE(std::isinf(scatterBeyondNoise({{1.0, 0.1}}).sigma));
}

/// For a mean, the jackknife is the usual formula.
TEST(WindowsTest, TheJackknifeOfAMeanIsItsStandardError) {
  const Eigen::RowVector4d values(1.0, 2.0, 4.0, 7.0);
  const Eigen::RowVector4d without = (values.sum() - values.array()) / 3.0;
  EXPECT_NEAR(jackknifeSigmas(without)[0], std::sqrt(21.0 / 3.0 / 4.0), 1e-12);
}

TEST(WindowsTest, DigitsFollowTheUncertainty) {
  EXPECT_EQ(toText(Estimate{0.70234, 0.0081}, "px"), "0.7023 +- 0.0081 px");
  EXPECT_EQ(toText(Estimate{12.3, 4.2}, ""), "12.3 +- 4.2");
}

}  // namespace
}  // namespace rotrocc
