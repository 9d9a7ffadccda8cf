#include "input/stereo_intake.h"

#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include "input/message_conversion.h"

namespace rotrocc {
namespace {

using Side = StereoIntake::Side;
using Counts = DropCounts;
using PairStamps = std::vector<int>;

constexpr double kPeriod_s = 0.1;
constexpr double kNow_s = 1000.0;

/// A rig at 10 Hz whose messages arrive as soon as they are taken, unless a test says otherwise.
class StereoIntakeTest : public testing::Test {
 protected:
  explicit StereoIntakeTest(const NodeParameters& parameters = {})
      : intake_(parameters, drops_, [this](const ReceivedPair& pair) {
          const double stamp_s = pair.images.left->header.stamp.toSec() - kNow_s;
          stamps_ms_.push_back(static_cast<int>(std::lround(1e3 * stamp_s)));
          last_pair_ = pair;
        }) {
    infos(0.0);
  }

  void info(Side side, double off_s, double baseline_m) {
    const auto info = boost::make_shared<sensor_msgs::CameraInfo>();
    info->header.stamp = ros::Time(kNow_s + time_s_ + off_s);
    info->width = 620;
    info->height = 188;
    info->K = {350, 0, 310, 0, 350, 94, 0, 0, 1};
    info->R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    info->P = {360, 0, 310, -360 * baseline_m, 0, 360, 94, 0, 0, 0, 1, 0};
    intake_.addInfo(side, info, arrival());
  }
  void infos(double off_s, double baseline_m = 0.5) {
    info(Side::kLeft, off_s, 0.0);
    info(Side::kRight, off_s, baseline_m);
  }

  /// An image of now, whose stamp is off.
  void image(Side side, double off_s = 0.0) {
    const auto image = boost::make_shared<sensor_msgs::Image>();
    image->header.stamp = ros::Time(kNow_s + time_s_ + off_s);
    intake_.addImage(side, image, arrival());
  }

  void pair(double left_off_s = 0.0, double right_off_s = 0.0) {
    image(Side::kLeft, left_off_s);
    image(Side::kRight, right_off_s);
    time_s_ += kPeriod_s;
  }

  void pairs(int count) {
    for (int i = 0; i < count; ++i) pair();
  }

  Arrival arrival() const {
    const std::chrono::microseconds time(std::llround(1e6 * time_s_));
    return {std::chrono::steady_clock::time_point(time),
            toNanoseconds(ros::Time(kNow_s + time_s_))};
  }

  double time_s_ = 0.0;   // since the start
  PairStamps stamps_ms_;  // of the pairs, since the start
  ReceivedPair last_pair_;
  DropLog drops_;
  StereoIntake intake_;
};

TEST_F(StereoIntakeTest, APairGoesOutWithItsSecondImage) {
  for (const Side side : {Side::kLeft, Side::kRight}) {
    stamps_ms_.clear();
    const Arrival first = arrival();
    image(side);
    EXPECT_TRUE(stamps_ms_.empty());
    time_s_ += 0.002;
    image(side == Side::kLeft ? Side::kRight : Side::kLeft);
    EXPECT_EQ(stamps_ms_.size(), 1u);
    EXPECT_EQ(last_pair_.images.first_arrival, first.time);
    EXPECT_EQ(last_pair_.arrival, arrival().time);
    time_s_ += kPeriod_s;
  }
  EXPECT_TRUE(drops_.counts().empty());
}

/// What was dropped for its stamp had a partner.
TEST_F(StereoIntakeTest, OnlyAnImageThatNeverCameIsMissing) {
  const auto others = [&] {
    const InputReport report = intake_.report(arrival().time);
    return report.unmatched.left + report.unmatched.right;
  };
  for (int i = 0; i < 40; ++i) pair(i % 2 == 0 ? -kNow_s - time_s_ : 0.0);
  EXPECT_EQ(stamps_ms_.size(), 20u);
  EXPECT_EQ(drops_.counts(),
            (Counts{{DropReason::kStampZero, 20}, {DropReason::kPartnerDropped, 20}}));
  EXPECT_EQ(others(), 0u);
  EXPECT_FALSE(faultOfPairs(intake_.report(arrival().time)));
  for (int i = 0; i < 20; ++i) {  // of both, there are no partners
    const double no_stamp_s = -kNow_s - time_s_;
    pair(no_stamp_s, no_stamp_s);
    image(Side::kLeft);
    time_s_ += kPeriod_s;
    pair();
  }
  EXPECT_EQ(drops_.counts(),
            (Counts{{DropReason::kStampZero, 60},
                    {DropReason::kNoPartner, 20},
                    {DropReason::kPartnerDropped, 20}}));
  EXPECT_GT(others(), 15u);
}

TEST_F(StereoIntakeTest, AnImageThatIsHeldComesOutInItsPlaceOrIsDropped) {
  pairs(8);
  pair(5.0, 5.0);  // a glitch of both, then of one
  pairs(2);
  pair(5.0);
  pairs(2);
  EXPECT_EQ(stamps_ms_, (PairStamps{0, 100, 200, 300, 400, 500, 600, 700, 900, 1000, 1200, 1300}));
  const Counts glitches = {{DropReason::kStampGlitch, 3}, {DropReason::kPartnerDropped, 1}};
  EXPECT_EQ(drops_.counts(), glitches);
  stamps_ms_.clear();
  pair(5.0, 5.0);  // time jumps
  EXPECT_EQ(stamps_ms_, PairStamps());
  pair(5.0, 5.0);
  EXPECT_EQ(stamps_ms_, (PairStamps{6400, 6500}));
  EXPECT_EQ(drops_.counts(), glitches);
}

/// The messages of a pair in any order: its own infos count, or else the newest ones.
TEST_F(StereoIntakeTest, APairGetsTheInfosOfItsStamp) {
  time_s_ += kPeriod_s;
  infos(0.0, 0.6);
  infos(kPeriod_s, 0.7);
  for (const double baseline_m : {0.6, 0.7, 0.7}) {
    pair();
    EXPECT_EQ(last_pair_.camera.baseline_m, baseline_m);
  }
  info(Side::kLeft, 0.0, 0.0);
  pair();  // without its right info
  EXPECT_EQ(last_pair_.camera.baseline_m, 0.7);
  infos(5.0);  // a glitch of camera_info
  pair();
  infos(-5.0);
  pair();
  EXPECT_EQ(stamps_ms_.size(), 6u);
  EXPECT_TRUE(drops_.counts().empty());
}

NodeParameters withRectify() {
  NodeParameters parameters;
  parameters.rectify = true;
  return parameters;
}

class RawStereoIntakeTest : public StereoIntakeTest {
 protected:
  RawStereoIntakeTest() : StereoIntakeTest(withRectify()) {}
};

TEST_F(RawStereoIntakeTest, PairsHaveTheSameCalibrationUntilACameraChanges) {
  pair();
  const auto first = last_pair_.calibration;
  ASSERT_TRUE(first);
  infos(0.0);
  pair();
  EXPECT_EQ(last_pair_.calibration, first);
  infos(0.0, 0.4);
  pair();
  EXPECT_NE(last_pair_.calibration, first);
  EXPECT_NEAR(last_pair_.calibration->rectified.baseline_m, 0.4, 1e-12);
  EXPECT_NEAR(first->rectified.baseline_m, 0.5, 1e-12);
}

}  // namespace
}  // namespace rotrocc
