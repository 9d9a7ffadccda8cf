#include "input/silence_watch.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/log_recorder.h"

namespace rotrocc {
namespace {

using std::chrono::seconds;

class SilenceWatchTest : public testing::Test {
 protected:
  SilenceWatchTest() {
    int i = 0;
    static const char* const kTopics[] = {"/l/image", "/r/image", "/l/info", "/r/info"};
    for (TopicReport* topic :
         {&input_.left_image, &input_.right_image, &input_.left_info, &input_.right_info}) {
      *topic = {kTopics[i++], 1, 0, 500, 0.0};
    }
  }

  /// Lets seconds pass; returns at which of them, counted from the start, there was a message.
  std::vector<int> wait(int seconds) {
    std::vector<int> said_s;
    for (const int end_s = now_s_ + seconds; now_s_ < end_s;) {
      ++now_s_;
      watch_.onTick(input_, now());
      const std::string said = logged();
      if (said.empty()) continue;
      said_s.push_back(now_s_);
      said_ = said;
    }
    return said_s;
  }

  std::string pair() {
    watch_.onPair({stamp_ns_ += 100'000'000, stamp_age_s_}, dropped_, now());
    return logged();
  }

  /// Since the last call.
  std::string logged() {
    const auto lines = recorder_.with("", ros::console::levels::Info);
    std::string added;
    for (; logged_ < lines.size(); ++logged_) added += lines[logged_];
    return added;
  }

  /// Pairs at a rate for some seconds; what is said at one of them.
  std::string pairs(double rate_hz, double length_s) {
    std::string said;
    for (int i = 0; i < length_s * rate_hz; ++i) {
      fraction_s_ += 1.0 / rate_hz;
      said += pair();
    }
    return said;
  }

  SilenceWatch::Time now() const {
    return SilenceWatch::Time() + seconds(now_s_) +
           std::chrono::milliseconds(std::lround(1e3 * fraction_s_));
  }

  int now_s_ = 0;
  double fraction_s_ = 0.0;
  std::int64_t stamp_ns_ = 0;
  double stamp_age_s_ = 0.1;
  std::uint64_t dropped_ = 0;
  InputReport input_;
  LogRecorder recorder_;
  std::size_t logged_ = 0;
  SilenceWatch watch_{5.0, now(), Log()};
  std::string said_;
};

using Times = std::vector<int>;

TEST_F(SilenceWatchTest, TellsOnceAndRemindsMoreAndMoreSeldom) {
  EXPECT_EQ(wait(240), (Times{5, 15, 35, 75, 135, 195}));
  EXPECT_EQ(said_.substr(0, said_.find(", /l/info")),
            "no stereo pair for 195 s. Messages in the last 5 s: /l/image 0, /r/image 0");
  EXPECT_NE(said_.find(". Likely: /l/image has a publisher"), std::string::npos) << said_;
}

TEST_F(SilenceWatchTest, SaysNothingWhileTheReplayStands) {
  input_.clock_stands = true;
  EXPECT_EQ(wait(100), Times());
  input_.clock_stands = false;
  EXPECT_EQ(wait(2), Times{101});
}

TEST_F(SilenceWatchTest, SaysThatPairsComeAgain) {
  EXPECT_EQ(wait(10), Times{5});
  EXPECT_EQ(pair(), "stereo pairs arrive again, after 10 s");
  EXPECT_EQ(pair(), "");
  // The next silence is reported like the first.
  EXPECT_EQ(wait(30), (Times{15, 25}));
  EXPECT_EQ(pair(), "stereo pairs arrive again, after 30 s");
}

TEST_F(SilenceWatchTest, TellsAGapAtItsEnd) {
  EXPECT_EQ(pairs(10.0, 3.0), "");
  fraction_s_ += 3.0;
  EXPECT_EQ(pair(), "stereo pairs arrive again, after 3.0 s");
  EXPECT_EQ(pairs(10.0, 10.0), "");
  fraction_s_ += 3.0;
  dropped_ += 15;  // of 29 pairs
  EXPECT_EQ(pair(), "");
  EXPECT_EQ(pairs(10.0, 10.0), "");
  fraction_s_ += 3.0;
  dropped_ += 1;
  EXPECT_EQ(pair(), "stereo pairs arrive again, after 3.0 s") << "one drop is not the cause";
}

TEST_F(SilenceWatchTest, TellsThatTheStampsJumpedForwardIfNoGapDoes) {
  pairs(10.0, 10.0);
  const std::string jump = "time jumped forward from 10.000 to 17.200 s: the odometry goes on";
  stamp_ns_ = 17'100'000'000;
  EXPECT_EQ(pairs(10.0, 1.0).find(jump), 0u);
  stamp_ns_ += 7'000'000'000;
  EXPECT_EQ(pairs(10.0, 1.0), "") << "at most every 5 s";
  EXPECT_EQ(pairs(10.0, 10.0), "");
  stamp_ns_ += 7'000'000'000;
  fraction_s_ += 7.0;
  EXPECT_EQ(pairs(10.0, 1.0), "stereo pairs arrive again, after 7.1 s");
  EXPECT_EQ(pairs(10.0, 10.0), "");
  stamp_ns_ += 7'000'000'000;
  stamp_age_s_ -= 7.0;
  EXPECT_EQ(pairs(10.0, 1.0), "") << "the clock did not jump";
}

TEST_F(SilenceWatchTest, ManyGapsAreNoStream) {
  EXPECT_EQ(pairs(10.0, 3.0), "");
  int said = 0;
  for (int i = 0; i < 20; ++i) {
    fraction_s_ += 1.5;
    said += pairs(10.0, 1.0).empty() ? 0 : 1;
  }
  EXPECT_EQ(said, 10);  // 50 s, at most each 5 s
}

TEST_F(SilenceWatchTest, SlowOrLossyCamerasHaveNoGaps) {
  EXPECT_EQ(pairs(0.5, 20.0), "");
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(pairs(2.0, 2.0), "") << i;
    fraction_s_ += 1.0;
  }
}

TEST_F(SilenceWatchTest, TellsWhatChanges) {
  EXPECT_EQ(wait(60), (Times{5, 15, 35}));
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
}

TEST_F(SilenceWatchTest, IsNoStreamWhateverChanges) {
  wait(60);
  std::size_t said = 0;
  for (int i = 0; i < 60; ++i) {
    input_.left_image.recent = i % 2;
    said += wait(1).size();
  }
  EXPECT_LE(said, 12u);  // every 5 s
}

}  // namespace
}  // namespace rotrocc
