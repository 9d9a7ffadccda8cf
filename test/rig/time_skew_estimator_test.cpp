#include "rig/time_skew_estimator.h"

#include <random>

#include <gtest/gtest.h>

#include "support/synthetic_scene.h"

namespace rotrocc {
namespace {

constexpr double kInterval_s = 0.1;
constexpr double kNoise_px = 0.3;

/// Pairs of features at random places, which move up and down by about `velocity_pxps`.
class Drive {
 public:
  /// The right image is taken later by `skew_s`.
  Drive(double skew_s, double velocity_pxps)
      : skew_s_(skew_s),
        camera_(SyntheticScene::defaultCamera()),
        velocity_pxps_(0.0, velocity_pxps) {}

  void show(int pairs, TimeSkewEstimator& estimator) {
    for (int i = 0; i < pairs; ++i) {
      Correspondences features;
      RowOffsets rows;
      for (std::size_t k = 0; k < 40; ++k) {
        const double velocity_pxps = velocity_pxps_(generator_);
        Correspondence feature;
        feature.cur_px = {x_(generator_) * camera_.width, x_(generator_) * camera_.height};
        feature.keyframe_px = feature.cur_px;
        feature.keyframe_px.y() -= kInterval_s * velocity_pxps;
        features.push_back(feature);
        rows.features.push_back(k);
        const double offset_px =
            k % 8 == 0 ? 2.0
                       : turned(feature.cur_px) + skew_s_ * velocity_pxps + noise_px_(generator_);
        rows.offsets_px.push_back(static_cast<float>(offset_px));
      }
      estimator.observe(camera_, features, rows, kInterval_s);
    }
  }

 private:
  /// The row offset of a turned camera.
  double turned(const Eigen::Vector2d& pixel) const {
    return 0.4 + 0.8 * (pixel.x() - camera_.cx) / camera_.fx -
           0.5 * (pixel.y() - camera_.cy) / camera_.fy;
  }

  double skew_s_;
  StereoCamera camera_;
  std::mt19937 generator_{1};
  std::uniform_real_distribution<double> x_{0.0, 1.0};
  std::normal_distribution<double> velocity_pxps_;
  std::normal_distribution<double> noise_px_{0.0, kNoise_px};
};

TEST(TimeSkewEstimatorTest, FindsTheSkewOfATurnedCamera) {
  for (const double skew_s : {-0.01, 0.0, 0.004}) {
    TimeSkewEstimator estimator;
    Drive(skew_s, 100.0).show(30, estimator);
    const TimeSkew skew = estimator.skew();
    // The noise of 1050 good features, and the floor that lenses ask for: 0.05 px.
    EXPECT_NEAR(skew.estimated_s, skew_s, 4.0 * kNoise_px / 100.0 / std::sqrt(1050.0));
    EXPECT_NEAR(skew.sigma_s, 0.05 / 100.0, 0.0002);
  }
}

TEST(TimeSkewEstimatorTest, KnowsNothingOfAFewFeatures) {
  TimeSkewEstimator estimator;
  Drive(0.01, 100.0).show(2, estimator);
  EXPECT_EQ(estimator.skew().sigma_s, 0.0);
  EXPECT_EQ(estimator.skew().estimated_s, 0.0);
}

TEST(TimeSkewEstimatorTest, IsUncertainAtStandstill) {
  TimeSkewEstimator estimator;
  Drive(0.01, 0.0).show(100, estimator);
  EXPECT_GT(estimator.skew().sigma_s, 0.05);
  EXPECT_LT(std::abs(estimator.skew().estimated_s), estimator.skew().sigma_s);
}

TEST(TimeSkewEstimatorTest, FollowsASkewThatChanges) {
  TimeSkewEstimator estimator;
  Drive(0.01, 100.0).show(100, estimator);
  Drive(-0.005, 100.0).show(500, estimator);
  EXPECT_NEAR(estimator.skew().estimated_s, -0.005, 0.0005);
  estimator.reset();
  EXPECT_EQ(estimator.skew().sigma_s, 0.0);
}

}  // namespace
}  // namespace rotrocc
