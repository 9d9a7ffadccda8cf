#include "input/stamp_guard.h"

#include <gtest/gtest.h>

#include "input/input_error.h"
#include "input/message_conversion.h"
#include "support/expect_error.h"

namespace rotrocc {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kNow_ns = 1'600'000'000 * kSecond_ns;

class StampGuardTest : public testing::Test {
 protected:
  /// A stamp [s from kNow_ns], at the same or another clock time.
  StampGuard::Verdict check(double stamp_s) { return check(stamp_s, stamp_s); }
  StampGuard::Verdict check(double stamp_s, double clock_s) {
    return guard_.check(ns(stamp_s), ns(clock_s));
  }

  /// Whether it is accepted, and nothing else is told.
  bool passes(double stamp_s) { return passes(stamp_s, stamp_s); }
  bool passes(double stamp_s, double clock_s) {
    const StampGuard::Verdict verdict = check(stamp_s, clock_s);
    return !verdict.held && !verdict.held_is_valid && !verdict.glitch;
  }

  bool isHeld(double stamp_s, double clock_s) { return check(stamp_s, clock_s).held; }

  void refuse(double stamp_s, const std::string& part) { refuse(stamp_s, stamp_s, part); }
  void refuse(double stamp_s, double clock_s, const std::string& part) {
    expectError<InputError>([&] { check(stamp_s, clock_s); }, part);
  }

  static std::int64_t ns(double seconds) {
    return kNow_ns + static_cast<std::int64_t>(seconds * 1e9);
  }

  StampGuard guard_{"the left image", 10.0};
};

TEST_F(StampGuardTest, StampsThatIncreasePass) {
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(passes(0.1 * i));
  EXPECT_TRUE(passes(1000.0));
}

TEST_F(StampGuardTest, ZeroIsNoStamp) {
  expectError<InputError>([&] { guard_.check(0, kNow_ns); }, "has the stamp 0: set header.stamp");
  EXPECT_TRUE(passes(0.0));
}

TEST_F(StampGuardTest, RepeatedStampsAreRefused) {
  EXPECT_TRUE(passes(0.0));
  refuse(0.0, "the same stamp as the previous one, 1600000000.000 s");
  EXPECT_TRUE(passes(0.1));
  EXPECT_TRUE(isHeld(5.0, 0.2));
  refuse(5.0, 0.3, "the same stamp as the previous one, 1600000005.000 s");
  EXPECT_TRUE(check(0.4).glitch);
}

TEST_F(StampGuardTest, OneThatIsOvertakenIsRefused) {
  EXPECT_TRUE(passes(0.0));
  EXPECT_TRUE(passes(0.2));
  refuse(0.1, 0.2, "1600000000.100 s, 0.1 s before");
  EXPECT_TRUE(passes(0.3));
  // Valid stamps in between reset the count towards a time jump.
  refuse(0.25, 0.3, "0.05 s before");
  EXPECT_TRUE(passes(0.4));
  refuse(0.35, 0.4, "before");
  EXPECT_TRUE(passes(0.5));
  refuse(0.45, 0.5, "before");
}

TEST_F(StampGuardTest, ABagInALoopRestarts) {
  EXPECT_TRUE(passes(0.0));
  EXPECT_TRUE(passes(20.0));
  EXPECT_TRUE(passes(0.0, 20.0));
  EXPECT_TRUE(passes(0.1, 20.1));
}

TEST_F(StampGuardTest, AShortLoopIsToldByTheClock) {
  EXPECT_TRUE(passes(0.0));
  EXPECT_TRUE(passes(0.5));
  EXPECT_TRUE(passes(0.0));
}

TEST_F(StampGuardTest, AShortLoopWithoutAClockIsToldByTheThirdImage) {
  EXPECT_TRUE(passes(0.5, 0.5));
  refuse(0.0, 0.6, "before");
  refuse(0.1, 0.7, "before");
  EXPECT_TRUE(passes(0.2, 0.8));
}

TEST_F(StampGuardTest, AnEarlierRunRestarts) {
  EXPECT_TRUE(passes(100.0));
  EXPECT_TRUE(passes(100.1));
  EXPECT_TRUE(passes(0.0, 100.2));
}

TEST_F(StampGuardTest, AGlitchIsToldByTheNextStamp) {
  for (int i = 0; i < 60; ++i) EXPECT_TRUE(passes(0.1 * i));
  for (const double glitch_s : {9.0, 2.0}) {
    EXPECT_TRUE(isHeld(glitch_s, 6.0)) << glitch_s;
    const StampGuard::Verdict verdict = check(6.1);
    EXPECT_FALSE(verdict.held || verdict.held_is_valid);
    ASSERT_TRUE(verdict.glitch);
    EXPECT_EQ(verdict.glitch->reason(), DropReason::kStampGlitch);
    guard_ = StampGuard("the left image", 10.0);
    for (int i = 0; i < 60; ++i) EXPECT_TRUE(passes(0.1 * i));
  }
}

TEST_F(StampGuardTest, AJumpIsConfirmedByTheNextStamp) {
  for (const double jump_s : {3.0, -3.0}) {
    guard_ = StampGuard("the left image", 10.0);
    for (int i = 0; i < 60; ++i) EXPECT_TRUE(passes(0.1 * i));
    EXPECT_TRUE(isHeld(6.0 + jump_s, 6.0)) << jump_s;
    const StampGuard::Verdict verdict = check(6.1 + jump_s, 6.1);
    EXPECT_TRUE(verdict.held_is_valid) << jump_s;
    EXPECT_FALSE(verdict.held || verdict.glitch);
    EXPECT_TRUE(passes(6.2 + jump_s, 6.2));
  }
}

TEST_F(StampGuardTest, AGapIsToldByTheClock) {
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(passes(0.1 * i));
  EXPECT_TRUE(passes(3.4));
  EXPECT_TRUE(passes(3.5));
}

/// Not even while the images before have come late.
TEST_F(StampGuardTest, ImagesThatComeInTimeAgainAreNoJump) {
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(passes(0.1 * i));
  for (int i = 20; i < 30; ++i) EXPECT_TRUE(passes(0.1 * i, 0.1 * i + 2.0));
  EXPECT_TRUE(passes(5.0));
}

TEST_F(StampGuardTest, StampsFarAheadOfTheClockAreRefused) {
  EXPECT_TRUE(passes(9.9, 0.0));
  refuse(11.0, 0.0, "11 s ahead of the clock: synchronise the clocks");
  EXPECT_TRUE(passes(10.0, 0.0));
}

TEST_F(StampGuardTest, WithoutAClockThereIsNoFuture) {
  EXPECT_NO_THROW(guard_.check(ns(1e6), 0));
}

TEST_F(StampGuardTest, StampsAtTheEndOfTimeDoNoHarm) {
  const std::int64_t end_ns = toNanoseconds(ros::TIME_MAX);
  EXPECT_FALSE(guard_.check(end_ns, 0).held);
  EXPECT_FALSE(guard_.check(1, 0).held);
  EXPECT_TRUE(guard_.check(end_ns, 0).held);
  EXPECT_TRUE(guard_.check(2, end_ns).glitch);
  EXPECT_FALSE(guard_.check(end_ns, end_ns).held);
}

}  // namespace
}  // namespace rotrocc
