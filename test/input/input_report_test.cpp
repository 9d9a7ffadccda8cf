#include "input/input_report.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(TopicStatisticsTest, AreThoseOfTheWindowAndOfTheRun) {
  TopicStatistics statistics;
  const TopicStatistics::Time start;
  EXPECT_EQ(statistics.rate_hz(start), 0.0);
  for (int i = 0; i < 100; ++i) statistics.add(start + i * milliseconds(100));
  const auto now = start + milliseconds(9900);
  EXPECT_EQ(statistics.total(), 100u);
  EXPECT_EQ(statistics.recent(now), 51u);
  EXPECT_NEAR(statistics.rate_hz(now), 10.0, 1e-9);
  EXPECT_EQ(statistics.recent(now + seconds(3)), 21u);
  EXPECT_EQ(statistics.rate_hz(now + seconds(6)), 0.0);
  EXPECT_EQ(statistics.startOfRun(), start);
  statistics.add(now + seconds(2));
  EXPECT_EQ(statistics.startOfRun(), now + seconds(2));
  EXPECT_EQ(statistics.since(now), 2u);
  for (int i = 0; i < 100000; ++i) statistics.add(now + seconds(2));
  EXPECT_LE(statistics.recent(now + seconds(2)), 2000u) << "a flood is bounded";
}

/// Of a rig that is well.
InputReport soundReport() {
  InputReport report;
  report.left_image = {"/l/image", 1, 50, 500, 10.0, 0.05};
  report.right_image = {"/r/image", 1, 50, 500, 10.0, 0.05};
  report.left_info = {"/l/info", 1, 50, 500, 10.0, 0.05};
  report.right_info = {"/r/info", 1, 50, 500, 10.0, 0.05};
  report.max_stamp_difference_s = report.tolerance_s = 0.01;
  report.period_s = 0.1;
  report.pairs_silent_s = 0.05;
  report.unmatched = {0, 0, 50};
  report.skew.emplace();
  report.recent_pairs = 50;
  return report;
}

using R = InputReport&;

struct Case {
  std::function<void(R)> change;
  std::string said;  // the beginning; empty: nothing is said
};

void expectSaid(std::optional<std::string> (*say)(const InputReport&),
                const std::vector<Case>& cases) {
  for (const auto& [change, said] : cases) {
    InputReport report = soundReport();
    change(report);
    const auto text = say(report);
    EXPECT_EQ(text ? text->substr(0, said.size()) : "", said);
    EXPECT_EQ(text.has_value(), !said.empty()) << text.value_or("");
  }
}

std::function<void(R)> skewed(std::size_t pairs, const StampSkew& skew) {
  return [=](R report) {
    report.recent_pairs = pairs;
    report.skew = skew;
  };
}

TEST(InputReportTest, SaysWhyThereAreNoPairs) {
  const auto silent = [](double silent_s, double rate_hz) {
    return [=](R r) {
      r.right_image.silent_s = silent_s;
      r.right_image.rate_hz = rate_hz;
    };
  };
  expectSaid(
      whyNoPairs,
      {{[](R) {}, ""},
       {[](R r) { r.right_image = {"/r/image"}; },
        "nobody publishes /r/image: start the driver, or remap it"},
       {[](R r) { r.right_image.publishers = r.right_image.recent = 0; },
        "nobody publishes /r/image any more: has the bag ended or the driver stopped?"},
       {[](R r) { r.left_image.recent = 0; },
        "/l/image has a publisher, but no messages arrive: is the driver running"},
       {silent(2.31, 10.0),
        "/r/image has been silent for 2.3 s: has the driver or the connection stopped?"},
       {silent(0.9, 10.0), ""},
       {silent(2.31, 0.5), ""},  // a slow camera
       {[](R r) { r.clock_missing = true; },
        "use_sim_time is true, but there is no message on /clock: play the bag with --clock"},
       {[](R r) {
          r.clock_stands = true;
          r.left_image.recent = 0;
        },
        "/clock stands still: the replay is paused or has ended"},
       {[](R r) {
          r.waits_for_info = true;
          r.right_info = {"/r/info"};
        },
        "nobody publishes /r/info"},
       {[](R r) { r.camera_error = "the baseline is zero"; }, "the baseline is zero"},
       {[](R r) { r.rejected = "the left image has the stamp 0"; },
        "the left image has the stamp 0"},
       {skewed(0, {0.02, {}, {}}),
        "left and right stamps are up to 20 ms apart, more than max_stamp_difference_s = 10 ms: "
        "trigger the cameras synchronously, or set max_stamp_difference_s to 0.024"},
       {skewed(0, {0.03, {}, {}}),  // whoever set the parameter would get pairs of different times
        "left and right stamps are up to 30 ms apart, more than 10 ms and 30 % of the period of "
        "100 ms: trigger the cameras synchronously; with a larger max_stamp_difference_s, images"},
       {skewed(0, {0.02, {}, -0.08}),
        "right stamps are 80 ms before the left ones with the same jitter, about a period"},
       {skewed(0, {3.1, {}, {}}),
        "left and right stamps are up to 3.1e+03 ms apart, more than max_stamp_difference_s = 10 "
        "ms: are both topics from the same rig, and the clocks of both drivers synchronized?"}});
}

TEST(InputReportTest, SaysWhatIsWrongWithPairs) {
  using Unmatched = decltype(InputReport::unmatched);
  const auto received = [](double right_hz, const Unmatched& unmatched) {
    return [=](R r) {
      r.right_image.rate_hz = right_hz;
      r.unmatched = unmatched;
    };
  };
  const auto aged = [](double age_s) { return [=](R r) { r.stamp_age_s = age_s; }; };
  expectSaid(
      faultOfPairs,
      {{[](R) {}, ""},
       {skewed(50, {0.03, 0.02, {}}), ""},
       {skewed(50, {0.03, -0.03, {}}),
        "left and right stamps are 30 ms apart, 30 % of the period of 100 ms, so images may be "
        "paired wrongly: trigger the cameras synchronously"},
       {skewed(50, {0.03, -0.03, 0.1}),
        "right stamps are 100 ms after the left ones with the same jitter, about a period, so "
        "images of different times have the nearest stamps: correct the stamps of the drivers"},
       {received(7.0, {15, 0, 35}),
        "30 % of the images have no partner: /l/image arrives at 10.0 Hz, /r/image at 7.0 Hz: "
        "the camera of /r/image or its connection loses images"},
       {received(10.0, {11, 10, 25}),
        "30 % of the images have no partner: /l/image arrives at 10.0 Hz, /r/image at 10.0 Hz: "
        "both lose images, or stamps are more than 10 ms apart"},
       {received(10.0, {50, 0, 950}), ""},
       {[](R r) { r.stamp_scatter_s = 0.009; }, ""},
       {[](R r) { r.stamp_scatter_s = 0.016; },
        "the stamps of /l/image scatter by 16 ms, 16 % of the period of 100 ms, and velocities "
        "with "
        "them: stamp images when they are exposed, not when they arrive"},
       {received(10.0, {3, 0, 1}), ""},  // at a start
       {aged(0.9), ""},
       {aged(-0.1), ""},
       {aged(20.0), "the stamps of /l/image are 20.0 s behind the clock on arrival"},
       {aged(-3.0), "the stamps of /l/image are 3.0 s ahead of the clock, so other nodes"},
       {aged(1e8), ""}});  // a replay without /clock
}

TEST(InputReportTest, TopicsAreLoggedInOneLine) {
  InputReport report = soundReport();
  report.right_image.recent = 0;
  report.right_image.rate_hz = 0.0;
  report.skew->largest_s = 0.0034;
  EXPECT_EQ(describeTopics(report),
            "/l/image 50 (10.0 Hz), /r/image 0, /l/info 50 (10.0 Hz), /r/info 50 (10.0 Hz); "
            "stamps of left and right differ by at most 3.4 ms");
}

}  // namespace
}  // namespace rotrocc
