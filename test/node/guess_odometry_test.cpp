#include "node/tf/guess_odometry.h"

#include <thread>

#include <gtest/gtest.h>

#include "support/log_recorder.h"
#include "support/tf_recording.h"

namespace rotrocc {
namespace {

constexpr double kPeriod_s = 0.1;
constexpr double kStep_m = 0.4;

TEST(MissBackoffTest, StopsWaitingAndTriesAgainNowAndThen) {
  MissBackoff backoff(10);
  int waits = 0;
  for (int i = 0; i < 100; ++i) {
    waits += backoff.waits();
    backoff.onMiss();
  }
  EXPECT_EQ(waits, MissBackoff::kMisses + 9);  // at 10, 20, ... 90
  backoff.onHit();
  EXPECT_TRUE(backoff.waits());
}

class GuessOdometryTest : public testing::Test {
 protected:
  /// tf of the wheels at a pair.
  void sendTf(int pair) {
    Eigen::Isometry3d T_guess_base = Eigen::Isometry3d::Identity();
    T_guess_base.translation().x() = kStep_m * pair;
    tf_.send("wheel_odom", "base_link", 100.0 + kPeriod_s * pair, T_guess_base);
  }

  /// The motion to a pair from the one before.
  std::optional<Eigen::Isometry3d> motionTo(int pair, GuessOdometry& guess) {
    guess.moveTo(stampOf(pair - 1));
    return guess.motionTo(stampOf(pair));
  }

  static std::int64_t stampOf(int pair) {
    return 100'000'000'000 + static_cast<std::int64_t>(pair) * 100'000'000;
  }

  TfRecording tf_;
  LogRecorder log_;
};

TEST_F(GuessOdometryTest, MotionIsThatOfTheBase) {
  GuessOdometry guess("wheel_odom", "base_link", 0.0, tf_.feed());
  sendTf(0);
  sendTf(1);
  const auto motion = motionTo(1, guess);
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->translation().x(), kStep_m, 1e-9);
  EXPECT_FALSE(guess.motionTo(stampOf(0))) << "it is asked for later pairs only";
  EXPECT_EQ(guess.misses(), 0u);
}

/// tf2 forgets after 10 s.
TEST_F(GuessOdometryTest, MotionIsKnownAcrossALongGap) {
  GuessOdometry guess("wheel_odom", "base_link", 0.0, tf_.feed());
  sendTf(0);
  guess.moveTo(stampOf(0));
  constexpr int kPairs = 300;
  for (int pair = 1; pair <= kPairs; ++pair) sendTf(pair);
  const auto motion = guess.motionTo(stampOf(kPairs));
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->translation().x(), kStep_m * kPairs, 1e-9);
}

/// With waiting at each pair, this takes an hour.
TEST_F(GuessOdometryTest, AFrameThatDoesNotExistIsToldOnceAndNotWaitedFor) {
  GuessOdometry guess("wheel_odom", "base_link", 0.2, tf_.feed());
  for (int pair = 1; pair < MissBackoff::kMisses; ++pair) {
    EXPECT_FALSE(motionTo(pair, guess));
    EXPECT_EQ(guess.trouble(), "") << pair;
  }
  constexpr int kPairs = 20'000;
  for (int pair = MissBackoff::kMisses; pair <= kPairs; ++pair) {
    EXPECT_FALSE(motionTo(pair, guess));
  }
  EXPECT_EQ(guess.misses(), static_cast<std::uint64_t>(kPairs));
  EXPECT_EQ(log_.with("wheel_odom").size(), 1u);
  EXPECT_NE(guess.trouble().find("\"wheel_odom\" passed to lookupTransform"), std::string::npos);
  EXPECT_NE(guess.trouble().find("correct guess_frame"), std::string::npos) << guess.trouble();
}

TEST_F(GuessOdometryTest, ItIsUsedAgainAsSoonAsItIsBack) {
  GuessOdometry guess("wheel_odom", "base_link", 0.0, tf_.feed());
  for (int pair = 1; pair <= 20; ++pair) EXPECT_FALSE(motionTo(pair, guess));
  EXPECT_NE(guess.trouble(), "");
  sendTf(20);
  sendTf(21);
  EXPECT_TRUE(motionTo(21, guess));
  EXPECT_EQ(guess.trouble(), "");
  EXPECT_EQ(guess.misses(), 20u);
}

/// Each transform comes only when the next pair is there.
TEST_F(GuessOdometryTest, WhatComesTooLateIsWaitedForNowAndThen) {
  GuessOdometry guess("wheel_odom", "base_link", 0.05, tf_.feed());
  constexpr int kPairs = 200;
  for (int pair = 1; pair <= kPairs; ++pair) {
    sendTf(pair - 1);
    EXPECT_FALSE(motionTo(pair, guess));
  }
  EXPECT_NE(guess.trouble().find("send it within 0.05 s, or"), std::string::npos)
      << guess.trouble();
  EXPECT_EQ(log_.with("wheel_odom").size(), 1u);
}

TEST_F(GuessOdometryTest, WaitsForWhatComesWithinTheTimeout) {
  GuessOdometry guess("wheel_odom", "base_link", 100.0, tf_.feed());
  for (int pair = 1; pair <= 3; ++pair) {
    sendTf(pair - 1);
    std::thread late([&] { sendTf(pair); });
    EXPECT_TRUE(motionTo(pair, guess));
    late.join();
  }
  EXPECT_EQ(guess.misses(), 0u);
}

}  // namespace
}  // namespace rotrocc
