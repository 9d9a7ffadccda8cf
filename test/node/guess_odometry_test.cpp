#include "node/tf/guess_odometry.h"

#include <gtest/gtest.h>

#include "support/log_recorder.h"
#include "support/tf_messages.h"

namespace rotrocc {
namespace {

constexpr double kPeriod_s = 0.1;
constexpr double kStep_m = 0.4;

TEST(SourceWatchTest, StopsWaitingAndTriesAgainNowAndThen) {
  SourceWatch watch(10);
  int waits = 0, logged = 0;
  for (int i = 0; i < 100; ++i) {
    waits += watch.waits();
    logged += watch.observe(false);
  }
  EXPECT_EQ(waits, SourceWatch::kPairs + 9);  // at 10, 20, ... 90
  EXPECT_EQ(logged, 1);
  EXPECT_FALSE(watch.observe(true)) << "it may be by chance";
  EXPECT_TRUE(watch.waits());
  for (int i = 1; i < SourceWatch::kPairs; ++i) logged += watch.observe(true);
  EXPECT_EQ(logged, 2);
}

class GuessOdometryTest : public testing::Test {
 protected:
  /// tf of the wheels at a pair.
  void sendWheels(int pair) {
    Eigen::Isometry3d T_guess_base = Eigen::Isometry3d::Identity();
    T_guess_base.translation().x() = kStep_m * pair;
    sendTf("wheel_odom", "base_link", 100.0 + kPeriod_s * pair, T_guess_base, tf_);
  }

  /// The motion to a pair from the one before.
  std::optional<Eigen::Isometry3d> motionTo(int pair) {
    guess_.moveTo(stampOf(pair - 1));
    return guess_.motionTo(stampOf(pair), wait_);
  }

  static std::int64_t stampOf(int pair) {
    return 100'000'000'000 + static_cast<std::int64_t>(pair) * 100'000'000;
  }

  tf2::BufferCore tf_;
  LogRecorder log_;
  GuessOdometry guess_{tf_, {"guess_frame wheel_odom", "wheel_odom", "base_link"}};
  /// What comes while a pair waits.
  std::function<void()> meanwhile_ = [] {};
  int waits_ = 0;
  WaitFor wait_ = [this](double, const std::function<bool()>& condition) {
    ++waits_;
    meanwhile_();
    return condition();
  };
};

TEST_F(GuessOdometryTest, MotionIsThatOfTheBase) {
  sendWheels(0);
  sendWheels(1);
  const auto motion = motionTo(1);
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->translation().x(), kStep_m, 1e-9);
  EXPECT_FALSE(guess_.motionTo(stampOf(0), wait_)) << "it is asked for later pairs only";
  EXPECT_EQ(guess_.misses(), 0u);
  EXPECT_EQ(waits_, 0);
}

/// tf2 forgets after 10 s.
TEST_F(GuessOdometryTest, MotionIsKnownAcrossALongGap) {
  sendWheels(0);
  guess_.moveTo(stampOf(0));
  constexpr int kPairs = 300;
  for (int pair = 1; pair <= kPairs; ++pair) sendWheels(pair);
  const auto motion = guess_.motionTo(stampOf(kPairs), wait_);
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->translation().x(), kStep_m * kPairs, 1e-9);
}

TEST_F(GuessOdometryTest, AFrameThatDoesNotExistIsLoggedOnceAndNotWaitedFor) {
  for (int pair = 1; pair < SourceWatch::kPairs; ++pair) {
    EXPECT_FALSE(motionTo(pair));
    EXPECT_EQ(guess_.problem(), "") << pair;
  }
  constexpr int kPairs = 1000;
  for (int pair = SourceWatch::kPairs; pair <= kPairs; ++pair) EXPECT_FALSE(motionTo(pair));
  EXPECT_EQ(waits_, SourceWatch::kPairs);
  EXPECT_EQ(guess_.misses(), static_cast<std::uint64_t>(kPairs));
  EXPECT_EQ(log_.with("wheel_odom").size(), 1u);
  EXPECT_NE(guess_.problem().find("no pose from guess_frame wheel_odom at 5 pairs in a row"),
            std::string::npos)
      << guess_.problem();

  sendWheels(kPairs);
  sendWheels(kPairs + 1);
  EXPECT_TRUE(motionTo(kPairs + 1)) << "it is used as soon as it is there";
  EXPECT_EQ(guess_.problem(), "");
}

/// Each transform comes only when the next pair is there.
TEST_F(GuessOdometryTest, WhatComesTooLateIsWaitedForNowAndThen) {
  constexpr int kPairs = 200;
  for (int pair = 1; pair <= kPairs; ++pair) {
    sendWheels(pair - 1);
    EXPECT_FALSE(motionTo(pair));
  }
  EXPECT_LE(waits_, SourceWatch::kPairs + kPairs / GuessOdometry::kRetryPairs);
  EXPECT_NE(guess_.problem().find("publish it within 0.05 s of its stamp"), std::string::npos)
      << guess_.problem();
  EXPECT_EQ(log_.with("wheel_odom").size(), 1u);
}

TEST_F(GuessOdometryTest, WaitsForWhatComesInTime) {
  for (int pair = 1; pair <= 3; ++pair) {
    sendWheels(pair - 1);
    meanwhile_ = [&] { sendWheels(pair); };
    EXPECT_TRUE(motionTo(pair));
  }
  EXPECT_EQ(guess_.misses(), 0u);
}

}  // namespace
}  // namespace rotrocc
