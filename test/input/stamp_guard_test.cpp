#include "input/stamp_guard.h"

#include <gtest/gtest.h>

#include "input/input_error.h"
#include "support/expect_error.h"

namespace rotrocc {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kNow_ns = 1'600'000'000 * kSecond_ns;

class StampGuardTest : public testing::Test {
 protected:
  /// A stamp [s from kNow_ns], at the same or another clock time.
  void pass(double stamp_s) { pass(stamp_s, stamp_s); }
  void pass(double stamp_s, double clock_s) { guard_.check(ns(stamp_s), ns(clock_s)); }

  void refuse(double stamp_s, const std::string& part) { refuse(stamp_s, stamp_s, part); }
  void refuse(double stamp_s, double clock_s, const std::string& part) {
    expectError<InputError>([&] { guard_.check(ns(stamp_s), ns(clock_s)); }, part);
  }

  static std::int64_t ns(double seconds) {
    return kNow_ns + static_cast<std::int64_t>(seconds * 1e9);
  }

  StampGuard guard_{"the left image", 10.0};
};

TEST_F(StampGuardTest, StampsThatIncreasePass) {
  for (int i = 0; i < 5; ++i) EXPECT_NO_THROW(pass(0.1 * i));
  EXPECT_NO_THROW(pass(1000.0));
}

TEST_F(StampGuardTest, ZeroIsNoStamp) {
  expectError<InputError>([&] { guard_.check(0, kNow_ns); }, "has the stamp 0: set header.stamp");
  EXPECT_NO_THROW(pass(0.0));
}

TEST_F(StampGuardTest, RepeatedStampsAreRefused) {
  pass(0.0);
  refuse(0.0, "the same stamp as the previous one, 1600000000.000 s");
  EXPECT_NO_THROW(pass(0.1));
}

TEST_F(StampGuardTest, OneThatIsOvertakenIsRefused) {
  pass(0.0);
  pass(0.2);
  refuse(0.1, 0.2, "1600000000.100 s, 0.1 s before");
  EXPECT_NO_THROW(pass(0.3));
  // Valid stamps in between reset the count towards a time jump.
  refuse(0.25, 0.3, "0.05 s before");
  EXPECT_NO_THROW(pass(0.4));
  refuse(0.35, 0.4, "before");
  EXPECT_NO_THROW(pass(0.5));
  refuse(0.45, 0.5, "before");
}

TEST_F(StampGuardTest, ABagInALoopBeginsAnew) {
  pass(0.0);
  pass(20.0);
  EXPECT_NO_THROW(pass(0.0, 20.0));
  EXPECT_NO_THROW(pass(0.1, 20.0));
}

TEST_F(StampGuardTest, AShortLoopIsToldByTheClock) {
  pass(0.0);
  pass(0.5);
  EXPECT_NO_THROW(pass(0.0));
}

TEST_F(StampGuardTest, AShortLoopWithoutAClockIsToldByTheThirdImage) {
  pass(0.5, 0.5);
  refuse(0.0, 0.6, "before");
  refuse(0.1, 0.7, "before");
  EXPECT_NO_THROW(pass(0.2, 0.8));
}

TEST_F(StampGuardTest, StampsFarAheadOfTheClockAreRefused) {
  EXPECT_NO_THROW(pass(9.9, 0.0));
  refuse(11.0, 0.0, "11 s ahead of the clock: synchronise the clocks");
  EXPECT_NO_THROW(pass(10.0, 0.0));
}

TEST_F(StampGuardTest, WithoutAClockThereIsNoFuture) {
  EXPECT_NO_THROW(guard_.check(ns(1e6), 0));
}

}  // namespace
}  // namespace rotrocc
