#include "inertial/gyro_predictor.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr int kSamplesPerPair = 20;
constexpr std::int64_t kSample_ns = 5 * kMs;
constexpr std::int64_t kPair_ns = kSamplesPerPair * kSample_ns;
constexpr double kVisionSigma_rad = 2e-4;

/// A camera and a gyroscope on one body, whose axes differ.
class Body {
 public:
  explicit Body(double swing_rad) : swing_rad_(swing_rad) {}

  /// The exact rotation of the camera between two pairs.
  Eigen::Matrix3d step(int pair) const { return camera(pair - 1).transpose() * camera(pair); }

  /// The samples since the previous pair, scaled, and the result of the odometry.
  OdometryResult drive(int pair, GyroPredictor& predictor, double scale = 1.0) {
    addSamples(pair, predictor, scale);
    return see(pair);
  }

  void addSamples(int pair, GyroPredictor& predictor, double scale = 1.0) const {
    for (int i = 1 - kSamplesPerPair; i <= 0; ++i) {
      const std::int64_t stamp_ns = pair * kPair_ns + i * kSample_ns;
      const double t = 1e-9 * static_cast<double>(stamp_ns);
      predictor.add({stamp_ns, scale * (R_camera_gyro.transpose() * rate(t) + bias_rps)});
    }
  }

  OdometryResult see(int pair) {
    OdometryResult result;
    result.state = State::kOk;
    result.stamp_ns = pair * kPair_ns;
    result.prev_stamp_ns = (pair - 1) * kPair_ns;
    const Eigen::Vector3d noise(normal_(generator_), normal_(generator_), normal_(generator_));
    result.T_prev_cur.linear() = expRotation(kVisionSigma_rad * noise) * step(pair);
    result.covariance.bottomRightCorner<3, 3>() =
        kVisionSigma_rad * kVisionSigma_rad * Eigen::Matrix3d::Identity();
    return result;
  }

  Eigen::Matrix3d R_camera_gyro =
      (Eigen::Matrix3d() << 0, -1, 0, 0, 0, -1, 1, 0, 0).finished();  // of a base, REP 103
  Eigen::Vector3d bias_rps = Eigen::Vector3d(0.03, -0.02, 0.05);

 private:
  Eigen::Matrix3d camera(int pair) const { return orientation(1e-9 * kPair_ns * pair); }

  Eigen::Matrix3d orientation(double t) const {
    return expRotation({0.0, swing_rad_ * std::sin(5.0 * t), 0.0}) *
           expRotation({0.3 * swing_rad_ * std::sin(7.0 * t), 0.0, 0.0});
  }

  Eigen::Vector3d rate(double t) const {
    constexpr double kStep_s = 1e-4;
    return logRotation(orientation(t - kStep_s).transpose() * orientation(t + kStep_s)) /
           (2.0 * kStep_s);
  }

  double swing_rad_;
  std::mt19937 generator_{1};
  std::normal_distribution<double> normal_;
};

constexpr double kFastSwing_rad = 0.4;  // up to 2 rad/s

double errorOf(const std::optional<Eigen::Matrix3d>& R, const Eigen::Matrix3d& truth) {
  return R ? logRotation(R->transpose() * truth).norm() : M_PI;
}

/// Runs the pairs from `first` up to before `end`.
void drive(Body& body, int first, int end, GyroPredictor& predictor, double scale = 1.0) {
  for (int pair = first; pair < end; ++pair) predictor.observe(body.drive(pair, predictor, scale));
}

TEST(GyroPredictorTest, LearnsTheBiasWhileMovingAndAtStandstill) {
  for (const double swing_rad : {kFastSwing_rad, 0.0}) {
    Body body(swing_rad);
    GyroPredictor predictor(body.R_camera_gyro);
    drive(body, 0, 50, predictor);
    // 5 s; the assumed noise of a gyroscope is 3e-4 rad in 0.1 s: 3e-3 rad/s by one pair.
    const double error_rps = (predictor.bias().bias_rps() - body.bias_rps).norm();
    EXPECT_LT(error_rps, 2e-3);
    EXPECT_LT(error_rps, 4.0 * std::sqrt(predictor.bias().covariance().trace()));
    EXPECT_EQ(predictor.whyDistrusted(), std::nullopt);
    body.addSamples(50, predictor);
    EXPECT_LT(errorOf(predictor.rotation(49 * kPair_ns, 50 * kPair_ns), body.step(50)), 3e-4);
  }
}

TEST(GyroPredictorTest, LearnsNothingFromPairsWithoutAReliableMotion) {
  Body body(kFastSwing_rad);
  GyroPredictor predictor(body.R_camera_gyro);
  for (const State state : {State::kInitializing, State::kDegraded, State::kLost}) {
    for (int pair = 0; pair < 3; ++pair) {
      OdometryResult result = body.drive(pair, predictor);
      result.state = state;
      predictor.observe(result);
    }
  }
  EXPECT_EQ(predictor.bias().bias_rps(), Eigen::Vector3d::Zero());
}

TEST(GyroPredictorTest, SaysWhatIsMissing) {
  GyroPredictor predictor;
  EXPECT_FALSE(predictor.rotation(0, kPair_ns));
  EXPECT_EQ(predictor.whyNot(), "there is no sample");
  EXPECT_EQ(predictor.counts().missed, 1u);
  predictor.add({0, Eigen::Vector3d::Constant(NAN)});
  EXPECT_EQ(predictor.counts().rejected, 1u);
  EXPECT_FALSE(predictor.rotation(0, kPair_ns));
  EXPECT_EQ(
      predictor.whyNot(),
      "there is no sample; the last sample was rejected: the angular velocity is not a number");
  predictor.miss("there is no tf");
  EXPECT_EQ(predictor.whyNot()->compare(0, 14, "there is no tf"), 0);
  EXPECT_EQ(predictor.counts().missed, 3u);
}

TEST(GyroPredictorTest, RejectsDegreesPerSecondUntilTheyAreRadians) {
  Body body(kFastSwing_rad);
  GyroPredictor predictor(body.R_camera_gyro);
  drive(body, 0, 10, predictor, 180.0 / M_PI);
  ASSERT_TRUE(predictor.whyDistrusted());
  EXPECT_NE(predictor.whyDistrusted()->find(" times those of the images: it seems to be in deg/s"),
            std::string::npos);
  body.addSamples(10, predictor, 180.0 / M_PI);
  EXPECT_FALSE(predictor.rotation(9 * kPair_ns, 10 * kPair_ns));
  EXPECT_EQ(predictor.whyNot(), predictor.whyDistrusted());
  drive(body, 11, 40, predictor);
  EXPECT_EQ(predictor.whyDistrusted(), std::nullopt);
  body.addSamples(40, predictor);
  EXPECT_LT(errorOf(predictor.rotation(39 * kPair_ns, 40 * kPair_ns), body.step(40)), 1e-3);
}

TEST(GyroPredictorTest, FollowsABiasThatHasJumped) {
  Body body(kFastSwing_rad);
  GyroPredictor predictor(body.R_camera_gyro);
  drive(body, 0, 50, predictor);
  body.bias_rps = Eigen::Vector3d(-0.2, 0.3, 0.1);
  drive(body, 50, 100, predictor);
  EXPECT_EQ(predictor.whyDistrusted(), std::nullopt);
  EXPECT_LT((predictor.bias().bias_rps() - body.bias_rps).norm(), 5e-3);
}

constexpr GyroTrust::Comparison kGood = {0.001, 0.001, 0.05, 0.05};
constexpr GyroTrust::Comparison kWrong = {0.06, 0.001, 0.05, 0.05};

void compare(GyroTrust& trust, const GyroTrust::Comparison& comparison, int times) {
  for (int i = 0; i < times; ++i) trust.compare(comparison);
}

TEST(GyroTrustTest, OneWrongMotionIsNoReason) {
  GyroTrust trust;
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(trust.compare(kWrong));
    EXPECT_TRUE(trust.compare(kGood));
  }
  compare(trust, {0.06, 0.03, 0.05, 0.05}, 20);  // within the uncertainty
  EXPECT_EQ(trust.whyNot(), std::nullopt);
}

TEST(GyroTrustTest, SeveralInARowAreUntilRotationsAgree) {
  GyroTrust trust;
  compare(trust, kWrong, 5);
  EXPECT_EQ(
      trust.whyNot(),
      "its rotations differ from those of the images by 3.4 deg per pair: check its "
      "stamps, and the tf from its frame to the camera's, on which roll and pitch of the first "
      "pose depend, too");
  compare(trust, {0.0005, 0.001, 0.0005, 0.0}, 1000);  // a standstill tells nothing
  EXPECT_NE(trust.whyNot(), std::nullopt);
  compare(trust, kGood, 4);
  compare(trust, kWrong, 1);
  compare(trust, kGood, 4);
  EXPECT_NE(trust.whyNot(), std::nullopt);
  compare(trust, kGood, 1);
  EXPECT_EQ(trust.whyNot(), std::nullopt);
}

}  // namespace
}  // namespace rotrocc
