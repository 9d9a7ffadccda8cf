#include "input/stereo_synchronizer.h"

#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include "input/message_conversion.h"

namespace rotrocc {
namespace {

constexpr double kMaxDifference_s = 0.01;
constexpr std::int64_t kMillisecond_ns = 1'000'000;

sensor_msgs::Image::ConstPtr makeImage(double stamp_ms) {
  const auto image = boost::make_shared<sensor_msgs::Image>();
  // An epoch as of a real robot, where a double would lose nanoseconds.
  image->header.stamp =
      toRosTime(1'600'000'000'000'000'000 + static_cast<std::int64_t>(stamp_ms * kMillisecond_ns));
  return image;
}

/// Whether an image of a side completes a pair, and right minus left stamp of that pair [ms].
struct Event {
  char side;  // l or r
  double stamp_ms;
  std::optional<double> skew_ms = std::nullopt;
};

class StereoSynchronizerTest : public testing::Test {
 protected:
  std::optional<double> add(char side, const sensor_msgs::Image::ConstPtr& image) {
    using Side = StereoSynchronizer::Side;
    const auto pair = synchronizer_.add(side == 'l' ? Side::kLeft : Side::kRight, image);
    if (!pair) return std::nullopt;
    return 1e3 * (pair->right->header.stamp - pair->left->header.stamp).toSec();
  }
  std::optional<double> left(double stamp_ms) { return add('l', makeImage(stamp_ms)); }
  std::optional<double> right(double stamp_ms) { return add('r', makeImage(stamp_ms)); }

  void expect(const std::vector<Event>& events, std::uint64_t unmatched) {
    for (const Event& event : events) {
      const auto skew_ms = add(event.side, makeImage(event.stamp_ms));
      ASSERT_EQ(skew_ms.has_value(), event.skew_ms.has_value()) << event.side << event.stamp_ms;
      if (skew_ms) {
        EXPECT_NEAR(*skew_ms, *event.skew_ms, 1e-3) << event.side << event.stamp_ms;
      }
    }
    EXPECT_EQ(synchronizer_.unmatched(), unmatched);
  }

  StereoSynchronizer synchronizer_{kMaxDifference_s, 4};
};

TEST_F(StereoSynchronizerTest, PairsAreOfTheNearestStampsWithinTheTolerance) {
  const struct {
    const char* what;
    std::vector<Event> events;
    std::uint64_t unmatched;
  } kCases[] = {
      {"the second image completes a pair",
       {{'l', 0}, {'r', 0, 0.0}, {'r', 100}, {'l', 100, 0.0}},
       0},
      {"the tolerance is inclusive", {{'l', 0}, {'r', 10, 10.0}, {'l', 100}, {'r', 110.001}}, 0},
      {"the nearest candidate wins; 107 can still be matched, 93 cannot",
       {{'r', 93}, {'r', 102}, {'r', 107}, {'l', 100, 2.0}, {'l', 108, -1.0}},
       1},
      {"one side may be late",
       {{'l', 0}, {'l', 100}, {'l', 200}, {'r', 3, 3.0}, {'r', 103, 3.0}, {'r', 203, 3.0}},
       0},
      {"an image that is skipped is unmatched; a late one waits",
       {{'l', 0}, {'l', 100}, {'r', 100, 0.0}, {'r', 0}},
       1},
      {"repeated stamps are not looked at",
       {{'l', 0}, {'l', 0}, {'r', 0, 0.0}, {'r', 0}, {'l', 0}},
       3},
      {"time jumps back on the left before the last right image arrives",
       {{'l', 900},
        {'r', 900, 0.0},
        {'l', 1000},
        {'l', 0},
        {'r', 1001},
        {'r', 0, 0.0},
        {'l', 100},
        {'r', 100, 0.0}},
       2},
      {"one side may be ahead after time jumps back",
       {{'l', 900}, {'r', 900, 0.0}, {'l', 0}, {'l', 100}, {'r', 0, 0.0}, {'r', 100, 0.0}},
       0},
  };
  for (const auto& [what, events, unmatched] : kCases) {
    SCOPED_TRACE(what);
    synchronizer_ = StereoSynchronizer(kMaxDifference_s, 4);
    expect(events, unmatched);
  }
}

TEST_F(StereoSynchronizerTest, QueuesAreBounded) {
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(left(100.0 * i));
  // 500 was discarded.
  expect({{'r', 500}, {'r', 600, 0.0}, {'r', 900, 0.0}}, 6 + 3);
}

TEST_F(StereoSynchronizerTest, ResetForgetsWhatWaits) {
  EXPECT_FALSE(left(0));
  synchronizer_.reset();
  expect({{'r', 0}, {'l', 0, 0.0}}, 0);
}

/// A camera at 30 Hz whose user has raised the tolerance beyond half a period.
class WideToleranceTest : public StereoSynchronizerTest {
 protected:
  static constexpr double kPeriod_ms = 1000.0 / 30.0;

  WideToleranceTest() { synchronizer_ = StereoSynchronizer(0.04, 4); }
};

TEST_F(WideToleranceTest, LostImagesLeaveTheOthersTogether) {
  std::mt19937 random(5);
  std::bernoulli_distribution lost(0.3);
  for (const bool left_too : {false, true}) {
    int both = 0, pairs = 0;
    for (int i = 0; i < 500; ++i) {
      const bool has_left = i < 2 || !left_too || !lost(random);
      const bool has_right = i < 2 || !lost(random);
      both += has_left && has_right ? 1 : 0;
      const bool right_first = i % 3 == 0;
      for (const bool is_right : {right_first, !right_first}) {
        if (is_right ? !has_right : !has_left) continue;
        const auto skew_ms = add(is_right ? 'r' : 'l', makeImage(i * kPeriod_ms));
        if (!skew_ms) continue;
        ++pairs;
        EXPECT_EQ(*skew_ms, 0.0) << i;
      }
    }
    EXPECT_EQ(pairs, both);
  }
}

/// Two images alone do not tell whether they are of one time: the next one does.
TEST_F(WideToleranceTest, TheFirstPairIsNotLost) {
  expect({{'l', 0}, {'r', 15}, {'l', kPeriod_ms, 15.0}}, 0);
  for (int i = 1; i < 20; ++i) {
    expect({{'r', 15 + i * kPeriod_ms, 15.0}, {'l', (i + 1) * kPeriod_ms}}, 0);
  }
  synchronizer_ = StereoSynchronizer(0.04, 4);
  expect({{'l', 0}, {'r', kPeriod_ms}, {'l', kPeriod_ms, 0.0}}, 1);  // the right one of 0 is lost
}

TEST_F(WideToleranceTest, ToleranceIsAtMostHalfThePeriod) {
  EXPECT_NEAR(synchronizer_.tolerance_s(), 0.01, 1e-9) << "while no period is known";
  for (int i = 0; i < 5; ++i) right(i * kPeriod_ms);
  EXPECT_NEAR(synchronizer_.tolerance_s(), 0.5e-3 * kPeriod_ms, 1e-6);
  for (int i = 0; i < 5; ++i) left(2 * i * kPeriod_ms);
  EXPECT_NEAR(synchronizer_.tolerance_s(), 0.5e-3 * kPeriod_ms, 1e-6);
}

}  // namespace
}  // namespace rotrocc
