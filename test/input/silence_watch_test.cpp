#include "input/silence_watch.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/log_recorder.h"

namespace rotrocc {
namespace {

using Times = std::vector<int>;

class SilenceWatchTest : public testing::Test {
 protected:
  SilenceWatchTest() {
    input_.left_image = {"/l/image", 1, 0, 500};
    input_.right_image = {"/r/image", 1, 0, 500};
    input_.left_info = {"/l/info", 1, 0, 500};
    input_.right_info = {"/r/info", 1, 0, 500};
  }

  /// Lets seconds pass; returns at which of them, counted from the start, there was a message.
  Times wait(int seconds) {
    Times said_s;
    for (; seconds > 0; --seconds) {
      now_s_ += 1.0;
      if (clock_moves_) clock_ns_ += 1'000'000'000;
      watch_.onTick(input_, {now(), clock_ns_});
      const std::string said = logged();
      if (said.empty()) continue;
      said_s.push_back(static_cast<int>(std::lround(now_s_)));
      said_ = said;
    }
    return said_s;
  }

  /// Pairs for some seconds; what is said at one of them.
  std::string pairs(double rate_hz, double length_s) {
    for (int i = 0; i < length_s * rate_hz; ++i) {
      now_s_ += 1.0 / rate_hz;
      stamp_ns_ += 100'000'000;
      watch_.onPair(stamp_ns_, stamp_age_s_, dropped_, now());
    }
    return logged();
  }
  std::string pairsAfter(double no_input_warning_s) {
    now_s_ += no_input_warning_s;
    return pairs(10.0, 10.0);
  }

  /// Since the last call.
  std::string logged() {
    const auto lines = recorder_.with("", ros::console::levels::Info);
    std::string added;
    for (; logged_ < lines.size(); ++logged_) added += lines[logged_];
    return added;
  }

  SilenceWatch::Time now() const {
    return SilenceWatch::Time() + std::chrono::milliseconds(std::lround(1e3 * now_s_));
  }

  double now_s_ = 0.0;
  bool clock_moves_ = true;
  std::int64_t clock_ns_ = 0;
  std::int64_t stamp_ns_ = 0;
  double stamp_age_s_ = 0.1;
  std::uint64_t dropped_ = 0;
  InputReport input_;
  LogRecorder recorder_;
  std::size_t logged_ = 0;
  SilenceWatch watch_{5.0, now(), Log()};
  std::string said_;
};

TEST_F(SilenceWatchTest, ReportsOnceRemindsMoreAndMoreSeldomAndReportsTheEnd) {
  EXPECT_EQ(wait(240), (Times{5, 35, 95, 215}));
  EXPECT_EQ(said_.substr(0, said_.find(", /l/info")),
            "no stereo pair for 215 s. Messages in the last 5 s: /l/image 0, /r/image 0");
  EXPECT_NE(said_.find(". Likely: /l/image has a publisher"), std::string::npos) << said_;
  EXPECT_EQ(pairs(10.0, 1.0), "stereo pairs arrive again, after 240 s");
  EXPECT_EQ(wait(9), (Times{246}));
}

TEST_F(SilenceWatchTest, SaysNothingWhileTheReplayStands) {
  clock_moves_ = false;
  EXPECT_EQ(wait(6), Times{5}) << "without a clock, it does not stand";
  clock_ns_ = 1;
  EXPECT_EQ(wait(100), Times());
  clock_moves_ = true;
  EXPECT_EQ(wait(2), Times{107});
}

TEST_F(SilenceWatchTest, ReportsAGapAtItsEnd) {
  const std::string told = "stereo pairs arrive again, after 3.1 s";
  EXPECT_EQ(pairs(10.0, 10.0), "");
  EXPECT_EQ(pairsAfter(3.0), told);
  dropped_ += 15;  // of 30 pairs
  EXPECT_EQ(pairsAfter(3.0), "");
  dropped_ += 1;
  EXPECT_EQ(pairsAfter(3.0), told) << "one drop is not the cause";
}

TEST_F(SilenceWatchTest, ReportsThatTheStampsJumpedForwardIfNoGapDoes) {
  pairs(10.0, 10.0);
  stamp_ns_ += 7'000'000'000;
  EXPECT_EQ(
      pairs(10.0, 1.0),
      "time jumped forward from 10.000 to 17.100 s: the odometry continues from the last pose");
  stamp_ns_ += 7'000'000'000;
  EXPECT_EQ(pairs(10.0, 10.0), "") << "at most every 5 s";
  stamp_ns_ += 7'000'000'000;
  EXPECT_EQ(pairsAfter(7.0), "stereo pairs arrive again, after 7.1 s");
  stamp_ns_ += 7'000'000'000;
  stamp_age_s_ -= 7.0;
  EXPECT_EQ(pairs(10.0, 1.0), "") << "the clock did not jump";
}

TEST_F(SilenceWatchTest, ManyGapsAreNoStream) {
  EXPECT_EQ(pairs(10.0, 3.0), "");
  int said = 0;
  for (int i = 0; i < 20; ++i) {
    now_s_ += 1.5;
    said += pairs(10.0, 1.0).empty() ? 0 : 1;
  }
  EXPECT_EQ(said, 10);  // 50 s, at most each 5 s
}

TEST_F(SilenceWatchTest, SlowOrLossyCamerasHaveNoGaps) {
  EXPECT_EQ(pairs(0.5, 20.0), "");
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(pairs(2.0, 2.0), "") << i;
    now_s_ += 1.0;
  }
}

TEST_F(SilenceWatchTest, ReportsWhatChangesEvery5SecondsAtMost) {
  EXPECT_EQ(wait(60), (Times{5, 35}));
  input_.right_image.recent = 3;
  EXPECT_EQ(wait(4), Times{61});
  EXPECT_NE(said_.find("/r/image 3"), std::string::npos) << said_;
  input_.right_image.recent = 30;  // still arrives
  EXPECT_EQ(wait(10), Times());
  input_.left_image.publishers = 0;
  EXPECT_EQ(wait(4), Times{75});
  EXPECT_NE(said_.find("nobody publishes /l/image any more"), std::string::npos) << said_;
  input_.camera_error = "the baseline is zero";
  EXPECT_EQ(wait(4), Times{80});
  input_.clock_missing = true;
  EXPECT_EQ(wait(10), Times{85});
  std::size_t said = 0;
  for (int i = 0; i < 60; ++i) {
    input_.left_image.recent = static_cast<std::size_t>(i % 2);
    said += wait(1).size();
  }
  EXPECT_LE(said, 12u);
}

}  // namespace
}  // namespace rotrocc
