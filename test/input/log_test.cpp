#include "input/log.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/log_recorder.h"

namespace rotrocc {
namespace {

using std::chrono::seconds;
using Seconds = std::vector<int>;

/// At which seconds it passes if it is asked at each of them.
Seconds passes(Throttle& throttle, int begin_s, int end_s) {
  Seconds passed_s;
  for (int now_s = begin_s; now_s < end_s; ++now_s) {
    if (throttle.pass(Throttle::Time(seconds(now_s)))) passed_s.push_back(now_s);
  }
  return passed_s;
}

TEST(ThrottleTest, WhatLastsIsReportedMoreAndMoreSeldom) {
  Throttle even(seconds(5));
  EXPECT_EQ(passes(even, 100, 120), (Seconds{100, 105, 110, 115}));
  Throttle rarely;
  EXPECT_EQ(passes(rarely, 100, 1300), (Seconds{100, 130, 190, 310, 550, 850, 1150}));
  EXPECT_EQ(passes(rarely, 1330, 1370), (Seconds{1330, 1360})) << "it was away";
}

TEST(FaultThrottleTest, EachFaultIsReportedAtOnce) {
  FaultThrottle throttle;
  const Throttle::Time now(seconds(100));
  EXPECT_TRUE(throttle.pass("frozen for 10 pairs", now));
  EXPECT_FALSE(throttle.pass("frozen for 11 pairs", now));
  EXPECT_TRUE(throttle.pass("dark", now));
  EXPECT_TRUE(throttle.pass("frozen for 400 pairs", now + seconds(30)));
}

TEST(LastingFaultTest, WhatIsShorterThanTheWindowOrBreaksOffIsHeldBack) {
  LastingFault fault(seconds(5));
  const auto at = [&](int now_s, const char* text) {
    return fault.observe(text, Throttle::Time(seconds(now_s)));
  };
  EXPECT_EQ(at(10, "3 lost"), "");
  EXPECT_EQ(at(15, "4 lost"), "");
  EXPECT_EQ(at(16, "5 lost"), "5 lost") << "since 10 s, whatever the number";
  EXPECT_EQ(at(17, ""), "");
  EXPECT_EQ(at(18, "5 lost"), "");
  EXPECT_EQ(at(24, "stamps apart"), "") << "another one";
  EXPECT_EQ(at(30, "stamps apart"), "stamps apart");
}

TEST(LogTest, EachNodeletHasALoggerAndEachLineItsCaller) {
  const LogRecorder recorder;
  const Log front("/front"), rear("/rear");
  ASSERT_TRUE(ros::console::set_logger_level("ros.rotrocc./rear", ros::console::levels::Error));
  ros::console::notifyLoggerLevelsChanged();
  for (const Log* log : {&front, &rear}) {
    log->warn("a warning of 100 %s");
    log->error("an error");
  }
  EXPECT_EQ(recorder.with("/rear"), std::vector<std::string>{"/rear: an error"});
  EXPECT_EQ(recorder.with("/front"),
            (std::vector<std::string>{"/front: a warning of 100 %s", "/front: an error"}));
  const int line = __LINE__ + 1;
  front.info("here");
  EXPECT_EQ(recorder.lastCaller(), std::string(__FILE__) + ":" + std::to_string(line));
}

}  // namespace
}  // namespace rotrocc
