#include "odometry/motion_check.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kPeriod_s = 0.1;
constexpr double kDepth_m = 15.0;

FeatureSet set(int inliers, int features) {
  FeatureSet flags(static_cast<std::size_t>(features), 0);
  std::fill(flags.begin(), flags.begin() + inliers, 1);
  return flags;
}

/// 10 m/s straight ahead, with 300 inliers of 400 features.
MotionEstimate goodEstimate() {
  MotionEstimate estimate;
  estimate.valid = true;
  estimate.flow_noise_px = 0.1;
  estimate.T_keyframe_cur = motion({0.0, 0.0, 1.0}, {0.0, 0.0, 0.0});
  estimate.rotation_inliers = set(300, 400);
  estimate.translation_inliers = set(300, 400);
  return estimate;
}

/// Expects both parts, or nothing if `value` is null.
void expectSays(const std::optional<std::string>& sentence, const char* value, const char* limit) {
  ASSERT_EQ(sentence.has_value(), value != nullptr) << sentence.value_or("");
  if (!sentence) return;
  EXPECT_NE(sentence->find(value), std::string::npos) << *sentence;
  EXPECT_NE(sentence->find(limit), std::string::npos) << *sentence;
}

MotionCheck defaultCheck() {
  return MotionCheck({});
}

/// Exact features all over the image (the R2 sequence of Roberts, 2018), so that the first ones are
/// as well.
Correspondences featuresAt(double depth_m, const Eigen::Isometry3d& T_keyframe_cur, int count) {
  const StereoCamera camera = kittiCamera();
  Correspondences features(static_cast<std::size_t>(count));
  double x = 0.5;
  double y = 0.5;
  for (Correspondence& feature : features) {
    x = std::fmod(x + 0.7548776662, 1.0);
    y = std::fmod(y + 0.5698402910, 1.0);
    feature.cur_px = {x * camera.width, y * camera.height};
    feature.disparity_px = camera.disparity(depth_m);
    feature.point_cur = depth_m * camera.ray(feature.cur_px);
    feature.keyframe_px = camera.project(T_keyframe_cur * feature.point_cur);
  }
  return features;
}

/// All features are equally deep and fit the motion, and all of the keyframe's features were
/// tracked.
Hypothesis hypothesis(const MotionEstimate& estimate) {
  Hypothesis hypothesis;
  hypothesis.camera = kittiCamera();
  hypothesis.has_prediction = true;
  hypothesis.estimate = estimate;
  hypothesis.features = featuresAt(
      kDepth_m, estimate.T_keyframe_cur, static_cast<int>(estimate.rotation_inliers.size()));
  hypothesis.counts.with_depth = static_cast<int>(hypothesis.features.size());
  hypothesis.counts.rotation_inliers = count(estimate.rotation_inliers);
  return hypothesis;
}

std::optional<std::string> whyDegraded(const Hypothesis& accepted) {
  return defaultCheck().whyDegraded(accepted, accepted.estimate.covariance);
}

TEST(MotionCheckTest, ReportsWhichMotionsAreLost) {
  struct Case {
    int by_rotation, by_translation, features;
    double down_m, turn_rad, dt_s;
    const char* value;
    const char* limit;
  };
  for (const Case& c : {Case{300, 300, 400, 0.0, 0.0, 0.1, nullptr, ""},
                        Case{24, 24, 24, 0.0, 0.0, 0.1, "24 features were matched", "than 25"},
                        Case{25, 25, 25, 0.0, 0.0, 0.1, nullptr, ""},
                        Case{0, 0, 0, 0.0, 0.0, 0.1, "only 0 features", "than 25"},
                        Case{300, 24, 400, 0.0, 0.0, 0.1, "24 features agree", "than 25"},
                        Case{24, 300, 400, 0.0, 0.0, 0.1, "24 features agree", "than 25"},
                        Case{300, 59, 400, 0.0, 0.0, 0.1, "0.147", "less than 0.15"},
                        Case{300, 60, 400, 0.0, 0.0, 0.1, nullptr, ""},
                        Case{300, 300, 400, 7.1, 0.0, 0.1, "71", "max_speed_mps = 70"},
                        Case{300, 300, 400, 7.1, 0.0, 0.2, nullptr, ""},
                        Case{300, 300, 400, 0.0, 0.61, 0.1, "6.1", "max_turn_rate_rps = 6"},
                        Case{300, 300, 400, 0.0, 0.61, 0.2, nullptr, ""}}) {
    auto estimate = goodEstimate();
    estimate.rotation_inliers = set(c.by_rotation, c.features);
    estimate.translation_inliers = set(c.by_translation, c.features);
    estimate.T_keyframe_cur = motion({0.0, c.down_m, 0.0}, {0.0, c.turn_rad, 0.0});
    const Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
    expectSays(defaultCheck().whyLost(hypothesis(estimate), start, c.dt_s), c.value, c.limit);
    estimate.valid = false;
    EXPECT_NE(defaultCheck().whyLost(hypothesis(estimate), start, c.dt_s), std::nullopt);
  }
}

TEST(MotionCheckTest, ReportsWhichMotionsAreDegraded) {
  struct Case {
    int by_rotation, by_translation;
    double ahead_m, sigma_m;
    const char* value;
    const char* limit;
  };
  for (const Case& c : {Case{300, 300, 1.0, 0.0, nullptr, ""},
                        Case{300, 199, 1.0, 0.0, "0.497", "translation, less than 0.5"},
                        Case{300, 200, 1.0, 0.0, nullptr, ""},
                        Case{279, 300, 1.0, 0.0, "0.698", "motion, less than 0.7"},
                        Case{280, 300, 1.0, 0.0, nullptr, ""},
                        Case{300, 300, 1.0, 0.051, "0.051", "more than 0.05 times 1 m"},
                        Case{300, 300, 1.0, 0.049, nullptr, ""},
                        // A short step is compared with the scene.
                        Case{300, 300, 0.0, 0.0151, "0.0151 m", "times 0.3 m"},
                        Case{300, 300, 0.0, 0.0149, nullptr, ""}}) {
    auto estimate = goodEstimate();
    estimate.rotation_inliers = set(c.by_rotation, 400);
    estimate.translation_inliers = set(c.by_translation, 400);
    estimate.T_keyframe_cur.translation().z() = c.ahead_m;
    estimate.covariance.topLeftCorner<3, 3>().setConstant(c.sigma_m * c.sigma_m / 3.0);
    expectSays(whyDegraded(hypothesis(estimate)), c.value, c.limit);
  }
}

TEST(MotionCheckTest, WantsMoreOfAMotionWithoutAPrediction) {
  struct Case {
    bool has_prediction;
    int by_rotation;
    const char* value;
    const char* limit;
  };
  for (const Case& c : {Case{true, 319, nullptr, ""},
                        Case{false, 319, "without a prediction, a fraction of 0.797", "0.8"},
                        Case{false, 320, nullptr, ""}}) {
    Hypothesis first = hypothesis(goodEstimate());
    first.has_prediction = c.has_prediction;
    first.estimate.rotation_inliers = set(c.by_rotation, 400);
    expectSays(whyDegraded(first), c.value, c.limit);
  }
}

TEST(MotionCheckTest, AMotionWithoutItsTranslationStageIsDegraded) {
  auto estimate = goodEstimate();
  estimate.translation_failed = true;
  expectSays(whyDegraded(hypothesis(estimate)), "translation stage", "than 25");
  estimate.translation_inliers = estimate.rotation_inliers = set(35, 49);
  EXPECT_EQ(whyDegraded(hypothesis(estimate)), std::nullopt) << "25 of 49 are more than half";
}

TEST(MotionCheckTest, FeaturesThatContradictHaveMostOfTheInformation) {
  const auto other = motion({0.5, 0.0, 0.2}, {0.0, 0.02, 0.0});
  const auto whyBeside = [&](double depth_m, int count) {
    Hypothesis mixed = hypothesis(goodEstimate());
    const Correspondences others = featuresAt(depth_m, other, count);
    std::copy(others.begin(), others.end(), mixed.features.end() - count);
    return whyDegraded(mixed);
  };
  expectSays(whyBeside(2.1 * kDepth_m, 40), "few features determine it", "");
  expectSays(whyBeside(kDepth_m, 79), "few features determine it", "");
}

TEST(MotionCheckTest, CallsAMotionThatOneFeatureDeterminesDegraded) {
  auto estimate = goodEstimate();
  estimate.rotation_inliers = estimate.translation_inliers = set(400, 400);
  Hypothesis far = hypothesis(estimate);
  far.features = featuresAt(2000.0, estimate.T_keyframe_cur, 400);
  const auto bringNear = [&](int count) {
    const Correspondences near = featuresAt(kDepth_m, estimate.T_keyframe_cur, count);
    std::copy(near.begin(), near.end(), far.features.begin());
  };
  bringNear(1);
  expectSays(whyDegraded(far), "information", "below 0.15");
  bringNear(40);
  EXPECT_EQ(whyDegraded(far), std::nullopt);
}

/// After a wrong search, a tenth of the features match somewhere.
TEST(MotionCheckTest, FewThatMayAgreeByChanceAreNoMotion) {
  const auto why = [](int agreeing, int tracked) {
    auto estimate = goodEstimate();
    estimate.rotation_inliers = estimate.translation_inliers = set(agreeing, tracked);
    Hypothesis found = hypothesis(estimate);
    found.counts.with_depth = 400;
    return defaultCheck().whyLost(found, Eigen::Isometry3d::Identity(), 0.1);
  };
  expectSays(why(25, 76), "25 of 76 tracked features", "400 in all");
  EXPECT_EQ(why(38, 76), std::nullopt) << "the majority";
  EXPECT_EQ(why(40, 200), std::nullopt) << "a tenth of all";
}

TEST(MotionCheckTest, FeaturesThatContradictMakeTheMotionUncertain) {
  auto estimate = goodEstimate();
  estimate.translation_inliers = set(50, 400);
  EXPECT_DOUBLE_EQ(MotionCheck::inflation(estimate, 0.02), 2.0 * 2.0) << "100 of 400 contradict";
  estimate.rotation_inliers = set(400, 400);
  EXPECT_DOUBLE_EQ(MotionCheck::inflation(estimate, 0.02), 2.0) << "50 features count as 25";
  estimate.rotation_inliers = set(100, 400);
  EXPECT_DOUBLE_EQ(MotionCheck::inflation(estimate, 0.02), 16.0 * 2.0)
      << "25 are the least majority";
}

/// Whether the camera rests after a motion, if the flow has this noise.
bool isAtRest(const Eigen::Isometry3d& T_keyframe_cur, double noise_px = 0.2, int features = 400) {
  std::mt19937 generator(1);
  Hypothesis accepted;
  accepted.camera = kittiCamera();
  accepted.estimate.T_keyframe_cur = T_keyframe_cur;
  accepted.estimate.flow_noise_px = noise_px;
  accepted.features =
      simulateFeatures(accepted.camera, T_keyframe_cur, features, {noise_px, noise_px}, generator);
  accepted.estimate.rotation_inliers.assign(accepted.features.size(), 1);
  return defaultCheck().isAtRest(accepted);
}

TEST(MotionCheckTest, DistinguishesRestFromMotion) {
  EXPECT_TRUE(isAtRest(Eigen::Isometry3d::Identity()));
  EXPECT_FALSE(isAtRest(motion({0.0, 0.0, 1.0}, {0.0, 0.0, 0.0})));
  const Eigen::Isometry3d slow = motion({0.0, 0.0, 0.0}, {0.0, 0.004, 0.0});  // 2.9 px
  EXPECT_FALSE(isAtRest(slow, 0.2));
  EXPECT_TRUE(isAtRest(slow, 0.65)) << "relative to the noise";
}

/// No feature leaves the image at rest.
TEST(MotionCheckTest, DoubtsARestThatFewOfTheKeyframesFeaturesShow) {
  auto estimate = goodEstimate();
  estimate.T_keyframe_cur = Eigen::Isometry3d::Identity();
  Hypothesis accepted = hypothesis(estimate);
  for (const bool is_at_rest : {true, false}) {
    if (!is_at_rest) accepted = hypothesis(goodEstimate());
    accepted.counts.with_depth = 428;  // 0.701
    EXPECT_EQ(defaultCheck().whyNotAtRest(accepted), std::nullopt);
    accepted.counts.with_depth = 430;  // 0.698
    const char* share = is_at_rest ? "0.698" : nullptr;
    expectSays(defaultCheck().whyNotAtRest(accepted), share, "less than 0.7");
    expectSays(whyDegraded(accepted), share, "seems stationary");
  }
}

/// Left and right may be of different times otherwise.
TEST(MotionCheckTest, WantsHalfOfTheTrackedFeaturesInBothImages) {
  Hypothesis accepted = hypothesis(goodEstimate());
  accepted.counts.consistent = 400;
  accepted.counts.tracked = 800;
  EXPECT_EQ(whyDegraded(accepted), std::nullopt);
  accepted.counts.tracked = 801;
  expectSays(whyDegraded(accepted), "400 of the 801", "less than 0.5");
}

TEST(MotionCheckTest, CallsAJumpDegraded) {
  const Eigen::Isometry3d expected = motion({0.0, 0.0, 1.0}, {0.0, 0.0, 0.0});
  UncertainTransform jump;
  jump.T = motion({0.0, 0.0, 1.31}, {0.0, 0.0, 0.0});
  expectSays(MotionCheck::whyJump(jump, expected, kPeriod_s), "31 m/s2", "more than 30");
  EXPECT_EQ(MotionCheck::whyJump(jump, expected, 2.0 * kPeriod_s),
            std::nullopt);              // a quarter of the acceleration
  jump.covariance(2, 2) = 0.01 * 0.01;  // 3 sigma = 0.03 m, equivalent to 3 m/s2
  EXPECT_EQ(MotionCheck::whyJump(jump, expected, kPeriod_s), std::nullopt);
  jump.T = motion({0.31, 0.0, 1.0}, {0.0, 0.0, 0.0});
  jump.covariance.setZero();
  EXPECT_NE(MotionCheck::whyJump(jump, expected, kPeriod_s), std::nullopt);
}

}  // namespace
}  // namespace rotrocc
