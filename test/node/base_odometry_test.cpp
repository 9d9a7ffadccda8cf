#include "node/base/base_odometry.h"

#include <cmath>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

constexpr std::int64_t kPeriod_ns = 100'000'000;

/// A camera 1 m ahead of and 2 m above the base that looks along the base's x axis.
Eigen::Isometry3d cameraMount() {
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
  T_base_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  T_base_camera.translation() << 1, 0, 2;
  return T_base_camera;
}

/// Forward by a step and to the left by an angle, seen by the base.
Eigen::Isometry3d makeMotion(double step_m, double left_rad) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation().x() = step_m;
  T.rotate(Eigen::AngleAxisd(left_rad, Eigen::Vector3d::UnitZ()));
  return T;
}

/// A pair whose motion is measured against the pair before and against a keyframe, if that is
/// another one.
OdometryResult found(std::int64_t stamp_ns,
                     const Eigen::Isometry3d& T_prev_cur,
                     const Matrix6d& covariance = 1e-6 * Matrix6d::Identity()) {
  OdometryResult result;
  result.state = State::kOk;
  result.stamp_ns = stamp_ns;
  result.prev_stamp_ns = stamp_ns - kPeriod_ns;
  result.T_prev_cur = T_prev_cur;
  result.covariance = covariance;
  result.keyframe_stamp_ns = stamp_ns - kPeriod_ns;
  result.T_keyframe_cur = {T_prev_cur, covariance};
  return result;
}

OdometryResult withoutMotion(std::int64_t stamp_ns, State state = State::kLost) {
  OdometryResult result;
  result.state = state;
  result.stamp_ns = stamp_ns;
  return result;
}

/// The motion of the camera while the base makes a motion.
Eigen::Isometry3d seen(const Eigen::Isometry3d& T_base) {
  return cameraMount().inverse() * T_base * cameraMount();
}

class BaseOdometryTest : public testing::Test {
 protected:
  /// A pair after which the base has made a motion.
  BaseState move(const Eigen::Isometry3d& T_base) {
    return odometry_.add(found(stamp_ns_ += kPeriod_ns, seen(T_base)), cameraMount());
  }

  /// A pair at rest, measured against an earlier one.
  BaseState rest(std::int64_t keyframe_stamp_ns) {
    OdometryResult result = found(stamp_ns_ += kPeriod_ns, Eigen::Isometry3d::Identity());
    result.covariance *= 2.0;
    result.prev_stamp_ns = result.keyframe_stamp_ns = keyframe_stamp_ns;
    return odometry_.add(result, cameraMount());
  }

  BaseState lose(std::int64_t passed_ns,
                 State state = State::kLost,
                 const std::optional<Eigen::Isometry3d>& T_last_cur = std::nullopt) {
    return odometry_.add(withoutMotion(stamp_ns_ += passed_ns, state), cameraMount(), T_last_cur);
  }

  static double sigma(const BaseState& state, int axis) {
    return std::sqrt(state.T_odom_base.covariance(axis, axis));
  }

  BaseOdometry odometry_{NodeParameters(), {0.0, 0.0}};
  std::int64_t stamp_ns_ = 5'000'000'000;
};

TEST(PlanarBaseTest, SaysIfItRemovesTheMotion) {
  NodeParameters parameters;
  parameters.planar = true;
  for (const bool up : {false, true}) {
    BaseOdometry odometry(parameters, SystematicErrorConfig());
    Eigen::Isometry3d mount = cameraMount();
    if (up) mount.linear().setIdentity();  // an optical frame that is named as that of the base
    for (int i = 1; i <= 20; ++i) {
      Eigen::Isometry3d ahead = Eigen::Isometry3d::Identity();
      ahead.translation().z() = 0.2;
      odometry.add(found(i * kPeriod_ns, ahead), mount);
    }
    const std::string problem = odometry.planarProblem();
    EXPECT_EQ(problem.find("planar has removed most of the motion, 4 of 4 m:"),
              up ? 0u : std::string::npos)
        << problem;
  }
}

TEST_F(BaseOdometryTest, VelocitiesAreAsUncertainAsTheStamps) {
  move(makeMotion(0.0, 0.0));
  OdometryResult result = found(stamp_ns_ += kPeriod_ns, seen(makeMotion(1.0, 0.0)));
  result.stamp_sigma_s = 0.008;
  const BaseState state = odometry_.add(result, cameraMount());
  EXPECT_NEAR(state.twist.twist.x(), 10.0, 1e-9);
  // The time between two such stamps errs by 11 %.
  EXPECT_NEAR(std::sqrt(state.twist.covariance(0, 0)), 10.0 * std::sqrt(2.0) * 0.08, 1e-3);
  EXPECT_LT(state.twist.covariance(1, 1), 1e-3 * state.twist.covariance(0, 0));
  EXPECT_EQ(state.step_velocity->twist.covariance(0, 0), state.twist.covariance(0, 0));
}

TEST_F(BaseOdometryTest, AStepOfTheClockIsNoTimeThatPasses) {
  move(makeMotion(0.0, 0.0));
  OdometryResult result = found(stamp_ns_ += kPeriod_ns, seen(makeMotion(1.0, 0.0)));
  result.clock_set_ns = -9'000'000'000;
  result.stamp_ns += result.clock_set_ns;
  EXPECT_NEAR(odometry_.add(result, cameraMount()).twist.twist.x(), 10.0, 1e-9);
  OdometryResult lost = withoutMotion(result.stamp_ns + kPeriod_ns);
  lost.clock_set_ns = result.clock_set_ns;
  const double sigma_m = std::sqrt(odometry_.add(lost, cameraMount()).T_odom_base.covariance(0, 0));
  EXPECT_GT(sigma_m, 0.9) << "the way of a period at 10 m/s";
  EXPECT_LT(sigma_m, 1.1);
  odometry_.addTimeUnseen(0.1);
  const BaseState later = odometry_.add(withoutMotion(0), cameraMount());
  EXPECT_NEAR(std::sqrt(later.T_odom_base.covariance(0, 0)), 2.0, 0.1);
}

TEST_F(BaseOdometryTest, FirstPairDefinesTheOdomFrame) {
  const BaseState state = lose(kPeriod_ns, State::kInitializing);
  EXPECT_EQ(state.stamp_ns, stamp_ns_);
  EXPECT_TRUE(state.T_odom_base.T.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_LT(sigma(state, 0), 1e-4);
  EXPECT_GT(sigma(state, 0), 0.0);
  EXPECT_EQ(state.twist.covariance(0, 0), 9999.0);
}

TEST_F(BaseOdometryTest, TwistAndVelocityOfTheStepMakeTheMotion) {
  move(makeMotion(1.0, 0.1));
  const Eigen::Isometry3d motion = makeMotion(0.7, 0.2);
  const BaseState state = move(motion);
  EXPECT_TRUE(expMotion(0.1 * state.twist.twist).isApprox(motion, 1e-9));
  // 1 mrad in 0.1 s.
  EXPECT_NEAR(state.twist.covariance(5, 5), 1e-4, 1e-12);
  // The velocity holds from the previous pair on.
  ASSERT_TRUE(state.step_velocity);
  EXPECT_EQ(state.step_velocity->stamp_ns, stamp_ns_ - kPeriod_ns);
  const Vector6d& twist = state.step_velocity->twist.twist;
  EXPECT_TRUE((0.1 * twist.head<3>()).isApprox(motion.translation(), 1e-9)) << twist;
  EXPECT_NEAR(0.1 * twist[5], 0.2, 1e-9);
  EXPECT_TRUE(state.step_velocity->twist.covariance.isApprox(state.twist.covariance));
  EXPECT_FALSE(lose(kPeriod_ns).step_velocity);
}

TEST_F(BaseOdometryTest, CovarianceGrowsOnTheWay) {
  double last = 0.0;
  for (int i = 0; i < 10; ++i) {
    const BaseState state = move(makeMotion(1.0, 0.0));
    EXPECT_GT(sigma(state, 0), last);
    last = sigma(state, 0);
  }
  // Ten steps of 1 mm each; along the path, rotation errors act only through the camera's height.
  EXPECT_NEAR(last, 1e-3 * std::sqrt(10.0 * (1.0 + 4.0)), 2e-4);
}

TEST_F(BaseOdometryTest, ErrorsAddUpFromReferenceToReference) {
  move(makeMotion(1.0, 0.0));
  const std::int64_t reference_ns = stamp_ns_;
  const double first = sigma(rest(reference_ns), 0);
  for (int i = 0; i < 100; ++i) EXPECT_DOUBLE_EQ(sigma(rest(reference_ns), 0), first);
  // The next keyframe is one of the pairs at rest.
  EXPECT_GT(sigma(rest(stamp_ns_), 0), 1.1 * first);
}

TEST_F(BaseOdometryTest, APairComparedWithOneBeforeALossIsAsCertainAsThat) {
  move(makeMotion(1.0, 0.0));
  const std::int64_t reference_ns = stamp_ns_;
  const double before = sigma(rest(reference_ns), 0);
  EXPECT_GT(sigma(lose(kPeriod_ns), 0), 5.0 * before);
  EXPECT_DOUBLE_EQ(sigma(rest(reference_ns), 0), before);
  // A pair measured against a lost one is at least as uncertain as that.
  const double lost = sigma(lose(kPeriod_ns), 0);
  EXPECT_GE(sigma(rest(stamp_ns_), 0), lost);
}

TEST_F(BaseOdometryTest, LostKeepsThePoseAndSaysItIsUnknown) {
  const BaseState before = move(makeMotion(1.0, 0.1));
  const BaseState lost = lose(kPeriod_ns);
  EXPECT_TRUE(lost.T_odom_base.T.isApprox(before.T_odom_base.T, 1e-14));
  EXPECT_EQ(lost.twist.twist.norm(), 0.0);
  EXPECT_TRUE(lost.twist.covariance.isApprox(9999.0 * Matrix6d::Identity()));
  EXPECT_NEAR(sigma(lost, 0), 1.0, 0.01) << "of 10 m/s";
  EXPECT_NEAR(sigma(lost, 5), 0.1, 0.01) << "of 1 rad/s";
  const BaseState after = move(makeMotion(1.0, 0.0));
  EXPECT_NEAR(
      (after.T_odom_base.T.translation() - lost.T_odom_base.T.translation()).norm(), 1.0, 1e-9);
  EXPECT_GE(sigma(after, 0), sigma(lost, 0));
}

TEST_F(BaseOdometryTest, GrowthDoesNotDependOnTheFrameRate) {
  const auto lostFor3s = [](int steps) {
    BaseOdometry odometry(NodeParameters(), {0.0, 0.0});
    BaseState state;
    for (int i = 0; i <= steps; ++i) {
      state = odometry.add(withoutMotion(i * 3'000'000'000 / steps), cameraMount());
    }
    return state;
  };
  EXPECT_TRUE(lostFor3s(1).T_odom_base.covariance.isApprox(lostFor3s(30).T_odom_base.covariance));
}

TEST_F(BaseOdometryTest, GrowsByWhatTheRobotMayDo) {
  const auto sigmaAfter = [](double speed_mps, double last_mps, double lost_s) {
    BaseOdometry odometry(NodeParameters(), {0.0, 0.0});
    std::int64_t stamp_ns = 0;
    for (const double mps : {speed_mps, last_mps}) {
      const Eigen::Isometry3d step = seen(makeMotion(0.1 * mps, 0.0));
      odometry.add(found(stamp_ns += kPeriod_ns, step), cameraMount());
    }
    const std::int64_t lost_ns = std::llround(1e9 * lost_s);
    return sigma(odometry.add(withoutMotion(stamp_ns + lost_ns), cameraMount()), 0);
  };
  EXPECT_LT(sigmaAfter(0.5, 0.0, 1.2), 1.2) << "a slow robot at rest";
  EXPECT_LT(sigmaAfter(0.5, 0.0, 20.0), 25.0) << "is not a car";
  EXPECT_GT(sigmaAfter(15.0, 0.0, 3.0), 4.0) << "a car at rest drives off";
  EXPECT_NEAR(sigmaAfter(15.0, 15.0, 3.0), 45.0, 1.0) << "a car drives on";
}

TEST_F(BaseOdometryTest, BeginsLevel) {
  NodeParameters node;
  node.initial_pose = {1.0, 2.0, 3.0, 0.0, 0.0, 1.5};
  const Eigen::Vector3d up = Eigen::Vector3d(0.1, -0.2, 0.9).normalized();
  BaseOdometry odometry(node, {0.0, 0.0}, up);
  const BaseState state = odometry.add(withoutMotion(0, State::kInitializing), cameraMount());
  const Eigen::Isometry3d& T = state.T_odom_base.T;
  EXPECT_TRUE((T.linear() * up).isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
  EXPECT_NEAR(std::atan2(T(1, 0), T(0, 0)), 1.5, 1e-12);
  EXPECT_TRUE(T.translation().isApprox(Eigen::Vector3d(1.0, 2.0, 3.0), 1e-12));
  EXPECT_NEAR(sigma(state, 3), 0.01, 1e-4);
  EXPECT_LT(sigma(state, 5), 1e-4);
}

TEST_F(BaseOdometryTest, TimeThatStepsBackAddsNothing) {
  move(makeMotion(1.0, 0.0));
  const BaseState before = lose(kPeriod_ns);
  const BaseState after = lose(-20 * kPeriod_ns, State::kInitializing);
  EXPECT_EQ(sigma(after, 0), sigma(before, 0));
}

TEST_F(BaseOdometryTest, GapsOfYearsLeaveNumbersThatFiltersCanUse) {
  lose(0, State::kInitializing);
  const BaseState state = lose(50'000'000LL * 1'000'000'000, State::kInitializing);
  EXPECT_NEAR(sigma(state, 0), 1000.0, 1.0) << "a walk of 1000 s";
}

TEST_F(BaseOdometryTest, AnotherOdometryMovesThePoseWhileLost) {
  const BaseState before = move(makeMotion(1.0, 0.1));
  const Eigen::Isometry3d step = makeMotion(0.5, 0.05);
  Eigen::Isometry3d expected = before.T_odom_base.T;
  BaseState state;
  for (int i = 0; i < 20; ++i) {
    state = lose(kPeriod_ns, State::kLost, step);
    expected = expected * step;
    EXPECT_TRUE(state.T_odom_base.T.isApprox(expected, 1e-9)) << i;
    EXPECT_EQ(state.twist.covariance(0, 0), 9999.0);
  }
  EXPECT_TRUE(state.T_first_camera.isApprox(seen(state.T_odom_base.T), 1e-9));
  // A tenth of 10 m, 1 rad and the turn of 0.1 rad/m; at the last speed and turn
  // rate the errors of two seconds would be 20 m and 2 rad.
  EXPECT_NEAR(sigma(state, 5), 0.1 * (1.0 + 0.1 * 10.0), 0.01);
  EXPECT_GT(sigma(state, 2), 0.99);
  EXPECT_LT(sigma(state, 0), 2.0);
  // A pair that is compared with a lost one goes on from there ...
  EXPECT_TRUE(
      move(makeMotion(1.0, 0.0)).T_odom_base.T.isApprox(expected * makeMotion(1.0, 0.0), 1e-9));
}

/// ... and one that is compared with a pair before the loss from that, as if nothing was lost.
TEST_F(BaseOdometryTest, TheOtherOdometryIsForgottenIfNothingWasLost) {
  move(makeMotion(1.0, 0.0));
  const std::int64_t keyframe_ns = stamp_ns_;
  const BaseState before = rest(keyframe_ns);
  lose(kPeriod_ns, State::kLost, makeMotion(0.5, 0.05));
  const BaseState after = rest(keyframe_ns);
  EXPECT_TRUE(after.T_odom_base.T.isApprox(before.T_odom_base.T, 1e-12));
  EXPECT_TRUE(after.T_first_camera.isApprox(before.T_first_camera, 1e-12));
  EXPECT_DOUBLE_EQ(sigma(after, 0), sigma(before, 0));
}

TEST_F(BaseOdometryTest, ASetPoseHasItsCovariance) {
  move(makeMotion(1.0, 0.2));
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal() << 0.04, 0.09, 0.01, 1e-6, 1e-6, 1e-4;
  covariance(0, 1) = covariance(1, 0) = 0.03;
  odometry_.setPose({makeMotion(50.0, 0.0), covariance});
  const BaseState state = lose(0);
  EXPECT_NEAR(state.T_odom_base.covariance(0, 1), 0.03, 1e-9);
  EXPECT_NEAR(sigma(state, 0), 0.2, 1e-6);
  // Its error of the heading moves the base across.
  const BaseState later = move(makeMotion(20.0, 0.0));
  EXPECT_NEAR(sigma(later, 1), std::hypot(0.3, 20.0 * 0.01), 1e-3);
}

TEST_F(BaseOdometryTest, BeginsAtTheInitialPose) {
  NodeParameters node;
  node.initial_pose = {1.0, 2.0, 3.0, 0.1, -0.2, 1.5};
  BaseOdometry odometry(node, {0.0, 0.0});
  const Eigen::Isometry3d T =
      odometry.add(withoutMotion(0, State::kInitializing), cameraMount()).T_odom_base.T;
  EXPECT_TRUE(T.translation().isApprox(Eigen::Vector3d(1.0, 2.0, 3.0), 1e-12));
  // Roll about x first, then pitch about y, then yaw about z of odom, as tf has it.
  const Eigen::Vector3d forward = T.linear().col(0);
  EXPECT_NEAR(std::atan2(forward.y(), forward.x()), 1.5, 1e-12);
  EXPECT_NEAR(std::asin(-forward.z()), -0.2, 1e-12);
  EXPECT_NEAR(std::atan2(T.linear()(2, 1), T.linear()(2, 2)), 0.1, 1e-12);
}

/// A camera on a pan-tilt head with a lever, on a base that drives a curve.
class MovingMountTest : public testing::Test {
 protected:
  static Eigen::Isometry3d mountAt(int pair) {
    Eigen::Isometry3d T_base_camera = cameraMount();
    T_base_camera.rotate(Eigen::AngleAxisd(0.3 * pair, Eigen::Vector3d::UnitY()));
    T_base_camera.rotate(Eigen::AngleAxisd(0.1 * pair, Eigen::Vector3d::UnitX()));
    T_base_camera.translate(Eigen::Vector3d(0.0, 0.05 * pair, 0.2));
    return T_base_camera;
  }

  static Eigen::Isometry3d baseAt(int pair) {
    Eigen::Isometry3d T_odom_base = Eigen::Isometry3d::Identity();
    for (int i = 0; i < pair; ++i) T_odom_base = T_odom_base * makeMotion(0.5, 0.02);
    return T_odom_base;
  }

  static Eigen::Isometry3d cameraAt(int pair) { return baseAt(pair) * mountAt(pair); }

  BaseState begin() { return odometry_.add(withoutMotion(0, State::kInitializing), mountAt(0)); }

  /// Measured against two earlier pairs.
  BaseState see(int pair, int prev, int keyframe) {
    OdometryResult result =
        found(pair * kPeriod_ns, cameraAt(prev).inverse() * cameraAt(pair), covariance_);
    result.prev_stamp_ns = prev * kPeriod_ns;
    result.keyframe_stamp_ns = keyframe * kPeriod_ns;
    result.T_keyframe_cur.T = cameraAt(keyframe).inverse() * cameraAt(pair);
    return odometry_.add(result, mountAt(pair));
  }

  BaseState lose(int pair) {
    return odometry_.add(withoutMotion(pair * kPeriod_ns), mountAt(pair));
  }

  BaseOdometry odometry_{NodeParameters(), {0.0, 0.0}};
  Matrix6d covariance_ = 1e-6 * Matrix6d::Identity();
};

TEST_F(MovingMountTest, ThePoseIsThatOfTheBase) {
  begin();
  for (int pair = 1; pair < 30; ++pair) {
    const BaseState state = see(pair, pair - 1, pair - 1);
    EXPECT_TRUE(state.T_odom_base.T.isApprox(baseAt(pair), 1e-9)) << pair;
    EXPECT_NEAR(state.twist.twist[0], 5.0, 0.01);
    EXPECT_NEAR(state.twist.twist[5], 0.2, 1e-9);
    // The camera's trajectory has the motion of the head.
    EXPECT_TRUE(state.T_first_camera.isApprox(cameraAt(0).inverse() * cameraAt(pair), 1e-9));
  }
}

/// The head has turned since the keyframe: errors along the view then are across it now.
TEST_F(MovingMountTest, TheCovarianceIsThatOfTheMotionSinceTheKeyframe) {
  covariance_ = 1e-12 * Matrix6d::Identity();
  covariance_(2, 2) = 1e-4;
  begin();
  BaseState state;
  for (int pair = 1; pair < 6; ++pair) state = see(pair, pair - 1, 0);
  const UncertainTransform since =
      compose(compose({mountAt(0)}, {cameraAt(0).inverse() * cameraAt(5), covariance_}),
              {mountAt(5).inverse()});
  EXPECT_TRUE((state.T_odom_base.covariance - since.covariance).cwiseAbs().maxCoeff() < 1e-7);
  EXPECT_NEAR(state.T_odom_base.covariance(0, 0), 1e-4, 1e-6) << "forward at the keyframe";
}

TEST_F(MovingMountTest, LostTheBaseRestsWhileTheHeadTurns) {
  begin();
  see(1, 0, 0);
  for (int pair = 2; pair < 5; ++pair) {
    const BaseState state = lose(pair);
    EXPECT_TRUE(state.T_odom_base.T.isApprox(baseAt(1), 1e-9));
    EXPECT_TRUE(
        state.T_first_camera.isApprox(cameraAt(0).inverse() * baseAt(1) * mountAt(pair), 1e-9));
  }
  // Compared with the pair before the loss, nothing is lost.
  EXPECT_TRUE(see(5, 1, 0).T_odom_base.T.isApprox(baseAt(5), 1e-9));
}

TEST_F(MovingMountTest, TheCameraIsExpectedWhereTheOtherOdometryTakesIt) {
  const std::optional<Eigen::Isometry3d> step = makeMotion(0.5, 0.02);
  begin();
  see(1, 0, 0);
  for (int pair = 2; pair < 5; ++pair) {
    const auto expected = odometry_.expectedMotion(mountAt(pair), step);
    ASSERT_TRUE(expected);
    EXPECT_TRUE(expected->isApprox(cameraAt(1).inverse() * cameraAt(pair), 1e-9)) << pair;
    odometry_.add(withoutMotion(pair * kPeriod_ns), mountAt(pair), step);
  }
  EXPECT_EQ(odometry_.lost_since_ns(), 2 * kPeriod_ns);
  lose(5);
  EXPECT_FALSE(odometry_.expectedMotion(mountAt(6), step)) << "a part of the way is unknown";
  see(6, 1, 1);
  EXPECT_TRUE(odometry_.expectedMotion(mountAt(7), step));
  EXPECT_FALSE(odometry_.lost_since_ns());
}

TEST_F(MovingMountTest, ComparedWithALostPairTheMountIsThatOfTheLostPair) {
  begin();
  see(1, 0, 0);
  lose(2);
  lose(3);
  const BaseState state = see(4, 3, 3);
  EXPECT_TRUE(state.T_odom_base.T.isApprox(baseAt(1) * makeMotion(0.5, 0.02), 1e-9));
  EXPECT_TRUE(see(5, 4, 3).T_odom_base.T.isApprox(
      baseAt(1) * makeMotion(0.5, 0.02) * makeMotion(0.5, 0.02), 1e-9));
}

TEST(PlanarOdometryTest, LeavesOutWhatIsNotInThePlane) {
  NodeParameters planar;
  planar.planar = true;
  BaseOdometry odometry(planar, {0.0, 0.0});
  Eigen::Isometry3d bump = makeMotion(1.0, 0.1);
  bump.translation().z() = 0.3;
  bump.rotate(Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY()));
  BaseState state;
  Eigen::Isometry3d expected = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 10; ++i) {
    state = odometry.add(found(i * kPeriod_ns, seen(bump)), cameraMount());
    expected = expected * makeMotion(1.0, 0.1);
  }
  EXPECT_TRUE(state.T_odom_base.T.isApprox(expected, 1e-9));
  EXPECT_NEAR(state.twist.twist[2], 0.0, 1e-9);
  EXPECT_NEAR(state.twist.twist[4], 0.0, 1e-9);
  const Matrix6d& covariance = state.T_odom_base.covariance;
  EXPECT_LT(covariance(2, 2), 1e-8);
  EXPECT_GT(covariance(2, 2), 0.0);
  EXPECT_LT(covariance(4, 4), 1e-8);
  EXPECT_GT(covariance(0, 0), 1e-6);
  EXPECT_GT(covariance(5, 5), 1e-6);
  EXPECT_TRUE(state.T_first_camera.isApprox(seen(expected), 1e-9));
}

/// Independent errors of 100 motions of 1 m would give 0.1 m.
TEST_F(BaseOdometryTest, SystematicErrorsGrowWithTheDistance) {
  BaseOdometry odometry(NodeParameters(), {0.01, 0.02});
  const Eigen::Isometry3d step = seen(makeMotion(1.0, 0.0));
  BaseState state;
  std::int64_t stamp_ns = 0;
  for (int i = 0; i < 100; ++i) {
    state = odometry.add(found(stamp_ns += kPeriod_ns, step, Matrix6d::Zero()), cameraMount());
  }
  EXPECT_NEAR(sigma(state, 0), 1.0, 0.01) << "along the way, by the scale";
  EXPECT_NEAR(sigma(state, 1), 2.0, 0.01) << "across it, by the axes";
  odometry.setPose({state.T_odom_base.T, Matrix6d::Zero()});
  state = odometry.add(found(stamp_ns + kPeriod_ns, step, Matrix6d::Zero()), cameraMount());
  EXPECT_NEAR(sigma(state, 0), 0.01, 1e-3);
}

}  // namespace
}  // namespace rotrocc
