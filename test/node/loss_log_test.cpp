#include "node/health/loss_log.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/log_recorder.h"

namespace rotrocc {
namespace {

using Lines = std::vector<std::string>;

const std::string kFew = "only 3 features agree on a motion";
const std::string kSwapped = "the images match if left and right are swapped: swap their topics";

class LossLogTest : public testing::Test {
 protected:
  /// A pair 100 ms after the one before; what it adds to the log.
  Lines pair(State state, const std::string& camera_fault = "") {
    now_ += std::chrono::milliseconds(100);
    OdometryResult result;
    result.state = state;
    if (state == State::kLost) result.reason = kFew;
    log_.observe(result, camera_fault, now_);
    const Lines all = recorder_.with("", ros::console::levels::Info);
    const Lines added(all.begin() + static_cast<std::ptrdiff_t>(lines_), all.end());
    lines_ = all.size();
    return added;
  }

  Lines pairs(int count, State state, const std::string& camera_fault = "") {
    Lines added;
    for (int i = 0; i < count; ++i) {
      for (const std::string& line : pair(state, camera_fault)) added.push_back(line);
    }
    return added;
  }

  LogRecorder recorder_;
  std::size_t lines_ = 0;
  Throttle::Time now_;
  LossLog log_{Log()};
};

constexpr auto kOk = State::kOk;
constexpr auto kLost = State::kLost;

TEST_F(LossLogTest, ALossWaitsForItsCause) {
  EXPECT_EQ(pairs(10, kLost), Lines());
  EXPECT_EQ(pair(kLost, kSwapped), Lines{"lost: " + kFew + "; " + kSwapped});
  EXPECT_EQ(pairs(10, kLost, kSwapped), Lines());
  EXPECT_EQ(pair(State::kInitializing), Lines()) << "no motion yet";
  EXPECT_EQ(pair(kLost), Lines());
  EXPECT_EQ(pairs(10, State::kDegraded), Lines());
  EXPECT_EQ(pair(kLost), Lines()) << "the motions were by chance";
  EXPECT_EQ(pairs(11, State::kDegraded), Lines{"recovered: degraded"});
}

TEST_F(LossLogTest, ALossOfUnknownCauseIsReportedAfterTwoSeconds) {
  EXPECT_EQ(pairs(20, kLost), Lines());
  EXPECT_EQ(pair(kLost), Lines{"lost: " + kFew});
  EXPECT_EQ(pairs(11, kOk), Lines{"recovered: ok"});
}

TEST_F(LossLogTest, AShortLossIsReportedAtItsEnd) {
  EXPECT_EQ(pairs(3, kLost), Lines());
  EXPECT_EQ(pairs(11, kOk), Lines{"lost for 0.3 s: " + kFew});
  EXPECT_EQ(pairs(200, kOk), Lines());
  pair(kLost);
  EXPECT_EQ(pairs(11, kOk), Lines()) << "the same again";
}

TEST_F(LossLogTest, AShortLossIsReportedWithItsCause) {
  pair(kLost);
  EXPECT_EQ(pairs(10, State::kDegraded, kSwapped), Lines());
  EXPECT_EQ(pair(State::kDegraded, kSwapped), Lines{"lost for 0.1 s: " + kFew + "; " + kSwapped});
}

TEST_F(LossLogTest, AFaultIsReportedAlsoWithoutALoss) {
  EXPECT_EQ(pair(kOk, kSwapped), Lines{kSwapped});
  EXPECT_EQ(pairs(100, kOk, kSwapped), Lines());
}

}  // namespace
}  // namespace rotrocc
