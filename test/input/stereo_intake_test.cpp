#include "input/stereo_intake.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include "input/message_conversion.h"

namespace rotrocc {
namespace {

using Side = StereoIntake::Side;
using Stamps = std::vector<int>;

constexpr double kPeriod_s = 0.1;
constexpr double kNow_s = 1000.0;

sensor_msgs::CameraInfo::ConstPtr makeInfo(double stamp_s, double baseline_m) {
  const auto info = boost::make_shared<sensor_msgs::CameraInfo>();
  info->header.stamp = ros::Time(stamp_s);
  info->width = 620;
  info->height = 188;
  info->P = {360, 0, 310, -360 * baseline_m, 0, 360, 94, 0, 0, 0, 1, 0};
  return info;
}

/// A rig at 10 Hz whose messages arrive as soon as they are taken, unless a test says otherwise.
class StereoIntakeTest : public testing::Test {
 protected:
  StereoIntakeTest() { restart(); }

  void infos(double off_s, double baseline_m = 0.5) {
    intake_->addInfo(Side::kLeft, makeInfo(kNow_s + time_s_ + off_s, 0.0), arrival());
    intake_->addInfo(Side::kRight, makeInfo(kNow_s + time_s_ + off_s, baseline_m), arrival());
  }

  /// An image of now, whose stamp is off.
  void image(Side side, double off_s = 0.0) {
    const auto image = boost::make_shared<sensor_msgs::Image>();
    image->header.stamp = ros::Time(kNow_s + stamp_s_ + off_s);
    intake_->addImage(side, image, arrival());
  }

  void pair(double left_off_s = 0.0, double right_off_s = 0.0) {
    image(Side::kLeft, left_off_s);
    image(Side::kRight, right_off_s);
    wait(kPeriod_s);
  }

  void pairs(int count) {
    for (int i = 0; i < count; ++i) pair();
  }

  /// Lets time pass, for clock and stamps.
  void wait(double seconds) {
    time_s_ += seconds;
    stamp_s_ += seconds;
  }

  /// Starts anew.
  void restart() {
    time_s_ = stamp_s_ = 0.0;
    stamps_ms_.clear();
    drops_.emplace();
    intake_.emplace(NodeParameters(), *drops_, [this](const ReceivedPair& pair) {
      const double stamp_s = pair.images.left->header.stamp.toSec() - kNow_s;
      stamps_ms_.push_back(static_cast<int>(std::lround(1e3 * stamp_s)));
      last_pair_ = pair;
    });
    infos(0.0);
  }

  /// Expects that no image was dropped but for these.
  void expectDropped(const DropLog::Counts& expected) const {
    EXPECT_EQ(drops_->counts(), expected);
  }

  std::string lastDrop() const {
    const auto last = drops_->lastWithin(std::chrono::seconds(60));
    return last ? last->what() : "";
  }

  Arrival arrival() const {
    return {start_ + std::chrono::microseconds(std::llround(1e6 * time_s_)),
            clock_known_ ? toNanoseconds(ros::Time(kNow_s + time_s_)) : 0};
  }

  double time_s_ = 0.0;   // since the start
  double stamp_s_ = 0.0;  // of the images of now, from the same origin
  bool clock_known_ = true;
  const std::chrono::steady_clock::time_point start_{};
  Stamps stamps_ms_;  // of the pairs, from the same origin
  ReceivedPair last_pair_;
  std::optional<DropLog> drops_;
  std::optional<StereoIntake> intake_;
};

TEST_F(StereoIntakeTest, APairGoesOutWithItsSecondImage) {
  for (const Side side : {Side::kLeft, Side::kRight}) {
    stamps_ms_.clear();
    const Arrival first = arrival();
    image(side);
    EXPECT_TRUE(stamps_ms_.empty());
    time_s_ += 0.02;
    image(side == Side::kLeft ? Side::kRight : Side::kLeft);
    EXPECT_EQ(stamps_ms_.size(), 1u);
    EXPECT_EQ(last_pair_.images.first_arrival, first.time);
    EXPECT_EQ(last_pair_.arrival, arrival().time);
    wait(kPeriod_s);
  }
  expectDropped({});
}

TEST_F(StereoIntakeTest, RepeatedStampsAreDropped) {
  image(Side::kLeft);
  image(Side::kLeft);
  wait(kPeriod_s);
  image(Side::kLeft, 5.0);  // held
  image(Side::kLeft, 5.0);
  wait(kPeriod_s);
  image(Side::kLeft);
  expectDropped({{DropReason::kStampRepeated, 2}, {DropReason::kStampGlitch, 1}});
}

TEST_F(StereoIntakeTest, ImagesThatAreOvertakenAreDropped) {
  pairs(3);
  for (int i = 0; i < 3; ++i) {  // valid ones in between are no jump back
    pair(-0.15, -0.15);
    pair();
  }
  EXPECT_EQ(stamps_ms_, (Stamps{0, 100, 200, 400, 600, 800}));
  expectDropped({{DropReason::kStampBackward, 6}});
}

TEST_F(StereoIntakeTest, AShortLoopIsToldByTheClockOrTheThirdImage) {
  pairs(6);
  stamp_s_ = 0.0;
  pairs(4);
  EXPECT_EQ(stamps_ms_, (Stamps{0, 100, 200, 300, 400, 500, 200, 300}));
  expectDropped({{DropReason::kStampBackward, 4}});
  restart();
  pairs(6);
  time_s_ = stamp_s_ = 0.0;
  pairs(2);
  EXPECT_EQ(stamps_ms_, (Stamps{0, 100, 200, 300, 400, 500, 0, 100}));
  expectDropped({});
}

TEST_F(StereoIntakeTest, StampsAtTheEndOfTimeDoNoHarm) {
  const auto add = [&](const ros::Time& stamp, std::int64_t clock_ns) {
    const auto image = boost::make_shared<sensor_msgs::Image>();
    image->header.stamp = stamp;
    intake_->addImage(Side::kLeft, image, {start_, clock_ns});
  };
  add(ros::TIME_MAX, 0);
  add(ros::Time(0, 1), 0);
  add(ros::TIME_MAX, 0);  // held
  expectDropped({{DropReason::kNoPartner, 1}});
  add(ros::Time(0, 2), toNanoseconds(ros::TIME_MAX));
  add(ros::TIME_MAX, toNanoseconds(ros::TIME_MAX));
  expectDropped({{DropReason::kStampGlitch, 1}, {DropReason::kNoPartner, 1}});
}

TEST_F(StereoIntakeTest, GlitchesAheadCostThemselves) {
  pairs(3);
  pair(5.0, 5.0);
  pairs(2);
  EXPECT_EQ(stamps_ms_, (Stamps{0, 100, 200, 400, 500}));
  expectDropped({{DropReason::kStampGlitch, 2}});
  EXPECT_EQ(
      lastDrop(),
      "the right image had the stamp 1005.300 s, 5.1 s after the previous one, but the next one "
      "did not follow it: a glitch; check where the driver takes header.stamp from");
  pair(2.0, 2.0);
  pair(7.0, 7.0);
  wait(6.0);  // just before a gap
  pair();
  EXPECT_EQ(stamps_ms_, (Stamps{0, 100, 200, 400, 500, 6800}));
  expectDropped({{DropReason::kStampGlitch, 6}});
}

/// What was dropped for its stamp had a partner.
TEST_F(StereoIntakeTest, OnlyAnImageThatNeverCameIsMissing) {
  const auto others = [&] {
    const InputReport report = intake_->report(arrival().time);
    return report.unmatched.left + report.unmatched.right;
  };
  for (int i = 0; i < 40; ++i) pair(i % 2 == 0 ? -kNow_s - stamp_s_ : 0.0);
  EXPECT_EQ(stamps_ms_.size(), 20u);
  expectDropped({{DropReason::kStampZero, 20}, {DropReason::kPartnerDropped, 20}});
  EXPECT_EQ(others(), 0u);
  EXPECT_EQ(faultOfPairs(intake_->report(arrival().time)), "");
  for (int i = 0; i < 20; ++i) {  // of both, there are no partners
    const double no_stamp_s = -kNow_s - stamp_s_;
    pair(no_stamp_s, no_stamp_s);
    image(Side::kLeft);
    wait(kPeriod_s);
    pair();
  }
  expectDropped({{DropReason::kStampZero, 60},
                 {DropReason::kNoPartner, 20},
                 {DropReason::kPartnerDropped, 20}});
  EXPECT_GT(others(), 15u);
}

/// Not as many images that seem to be late that time seems to have jumped back.
TEST_F(StereoIntakeTest, AGlitchCostsItsPairAndNoRestart) {
  const DropLog::Counts both = {{DropReason::kStampGlitch, 2}};
  const DropLog::Counts one = {{DropReason::kStampGlitch, 1}, {DropReason::kPartnerDropped, 1}};
  const struct {
    double left_off_s, right_off_s;
    DropLog::Counts dropped;
    const char* said;
  } kCases[] = {{-5.0, -5.0, both, "4.9 s before the previous one"},
                {0.35, 0.35, both, "0.45 s after the previous one"},
                {0.5, 0.5, both, "0.6 s after"},
                {0.9, 0.9, both, "1 s after"},
                {5.0, 0.0, one, "the left image had the stamp"},
                {0.0, 5.0, one, "the right image had the stamp"}};
  for (const auto& [left_off_s, right_off_s, dropped, said] : kCases) {
    restart();
    pairs(80);
    pair(left_off_s, right_off_s);
    pairs(3);
    EXPECT_EQ(stamps_ms_.size(), 83u) << left_off_s;
    EXPECT_TRUE(std::is_sorted(stamps_ms_.begin(), stamps_ms_.end())) << left_off_s;
    expectDropped(dropped);
    EXPECT_NE(lastDrop().find(said), std::string::npos) << lastDrop();
  }
}

TEST_F(StereoIntakeTest, AGapOfTheInputCostsNothing) {
  pairs(3);
  wait(3.0);
  pair();
  EXPECT_EQ(stamps_ms_, (Stamps{0, 100, 200, 3300}));
  expectDropped({});
}

/// As of a bag with a gap whose player skips it, of a camera whose clock was set, or in simulated
/// time before the first /clock.
TEST_F(StereoIntakeTest, AJumpOfTheStampsAloneIsFollowedWithTheNextImage) {
  for (const double jump_s : {5.0, -5.0}) {
    for (const bool clock_known : {true, false}) {
      clock_known_ = clock_known;
      restart();
      pairs(80);
      stamp_s_ += jump_s;
      pair();
      EXPECT_EQ(stamps_ms_.size(), 80u) << jump_s;
      pairs(2);
      EXPECT_EQ(stamps_ms_.size(), 83u) << jump_s;
      EXPECT_EQ(stamps_ms_[80], std::lround(1e3 * (8.0 + jump_s)));
      expectDropped({});
    }
  }
}

TEST_F(StereoIntakeTest, ALoopBeginsAtOnce) {
  pairs(80);
  stamp_s_ = 0.0;  // the clock goes on
  pair();
  EXPECT_EQ(stamps_ms_.size(), 81u);
  pairs(80);
  time_s_ -= 4.0;  // both go back
  stamp_s_ -= 4.0;
  pair();
  EXPECT_EQ(stamps_ms_.size(), 162u);
  stamp_s_ = -100.0;  // an earlier run
  pair();
  EXPECT_EQ(stamps_ms_.size(), 163u);
  expectDropped({});
}

/// A link that stands for a second, then brings what it has kept.
TEST_F(StereoIntakeTest, LateImagesAreNoJump) {
  pairs(20);
  time_s_ += 1.0;
  for (int i = 0; i < 5; ++i) {
    pair();
    time_s_ -= kPeriod_s;
  }
  stamp_s_ = time_s_;
  pairs(3);
  EXPECT_EQ(stamps_ms_.size(), 28u);
  expectDropped({});
}

TEST_F(StereoIntakeTest, AFastReplayWithLostImagesIsFollowed) {
  constexpr double kRate = 10.0;
  for (int i = 0; i < 60; ++i) {
    if (i % 7 == 5) stamp_s_ += 4 * kPeriod_s;
    pair();
    time_s_ -= kPeriod_s - kPeriod_s / kRate;
  }
  EXPECT_EQ(stamps_ms_.size(), 60u);
  expectDropped({});
}

TEST_F(StereoIntakeTest, AGlitchOfCameraInfoDoesNoHarm) {
  pairs(3);
  infos(5.0);
  pairs(1);
  infos(-5.0);
  pairs(1);
  EXPECT_EQ(stamps_ms_, (Stamps{0, 100, 200, 300, 400}));
  expectDropped({});
}

/// The messages of a pair in any order: its own infos count, or else the newest ones.
TEST_F(StereoIntakeTest, APairGetsTheInfosOfItsStamp) {
  const auto expectBaseline = [&](double baseline_m) {
    EXPECT_EQ(last_pair_.camera.baseline_m, baseline_m);
  };
  wait(kPeriod_s);
  infos(0.0, 0.6);
  infos(kPeriod_s, 0.7);
  pair();
  expectBaseline(0.6);
  pair();
  expectBaseline(0.7);
  pair();
  expectBaseline(0.7);
  const auto left = makeInfo(kNow_s + time_s_, 0.0);
  intake_->addInfo(Side::kLeft, left, arrival());
  pair();  // without its right info
  expectBaseline(0.7);
  expectDropped({});
}

}  // namespace
}  // namespace rotrocc
