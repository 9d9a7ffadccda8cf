#include "input/stereo_synchronizer.h"

#include <vector>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include "input/message_conversion.h"

namespace rotrocc {
namespace {

constexpr double kPeriod_ms = 1000.0 / 30.0;

/// Whether an image of a side completes a pair, and right minus left stamp of that pair [ms].
struct Event {
  char side;  // l or r
  double stamp_ms;
  std::optional<double> skew_ms = {};
};

class StereoSynchronizerTest : public testing::Test {
 protected:
  std::optional<double> add(char side, double stamp_ms) {
    using Side = StereoSynchronizer::Side;
    const auto image = boost::make_shared<sensor_msgs::Image>();
    // An epoch as of a real robot, where a double would lose nanoseconds.
    image->header.stamp =
        toRosTime(1'600'000'000'000'000'000 + static_cast<std::int64_t>(1e6 * stamp_ms));
    const auto pair = synchronizer_.add(side == 'l' ? Side::kLeft : Side::kRight, image);
    if (!pair) return std::nullopt;
    return 1e3 * (pair->right->header.stamp - pair->left->header.stamp).toSec();
  }

  void expect(const std::vector<Event>& events, std::uint64_t unmatched) {
    for (const Event& event : events) {
      const auto skew_ms = add(event.side, event.stamp_ms);
      ASSERT_EQ(skew_ms.has_value(), event.skew_ms.has_value()) << event.side << event.stamp_ms;
      if (skew_ms) {
        EXPECT_NEAR(*skew_ms, *event.skew_ms, 1e-3) << event.side << event.stamp_ms;
      }
    }
    EXPECT_EQ(synchronizer_.unmatched(), unmatched);
  }

  StereoSynchronizer synchronizer_{0.01, 4};
};

TEST_F(StereoSynchronizerTest, PairsAreCompleteWithTheSecondImage) {
  const struct {
    const char* what;
    std::vector<Event> events;
    std::uint64_t unmatched;
    double max_difference_s = 0.01;
  } kCases[] = {
      {"either side is first", {{'l', 0}, {'r', 0, 0.0}, {'r', 100}, {'l', 100, 0.0}}, 0},
      {"the tolerance is inclusive", {{'l', 0}, {'r', 10, 10.0}, {'l', 100}, {'r', 110.001}}, 0},
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
      {"queues are bounded: 100 was discarded",
       {{'l', 0}, {'l', 100}, {'l', 200}, {'l', 300}, {'l', 400}, {'l', 500}, {'r', 100}},
       2},
      {"two images alone do not tell whether they are of one time: the next one does",
       {{'l', 0}, {'r', 15}, {'l', kPeriod_ms, 15.0}, {'r', 15 + kPeriod_ms, 15.0}},
       0,
       0.04},
      {"the user has raised the tolerance beyond half a period; a right image is lost",
       {{'l', 0}, {'r', kPeriod_ms}, {'l', kPeriod_ms, 0.0}},
       1,
       0.04},
  };
  for (const auto& [what, events, unmatched, max_difference_s] : kCases) {
    SCOPED_TRACE(what);
    synchronizer_ = StereoSynchronizer(max_difference_s, 4);
    expect(events, unmatched);
  }
  EXPECT_NEAR(1e-6 * static_cast<double>(synchronizer_.tolerance_ns()), 0.5 * kPeriod_ms, 1e-3);
}

}  // namespace
}  // namespace rotrocc
