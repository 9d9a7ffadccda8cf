#include "input/input_report.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "input/topic_statistics.h"

namespace rotrocc {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(TopicStatisticsTest, RateAndCountAreThoseOfTheWindow) {
  TopicStatistics statistics;
  const TopicStatistics::Time start;
  EXPECT_EQ(statistics.rate_hz(start), 0.0);
  for (int i = 0; i < 100; ++i) statistics.add(start + i * milliseconds(100));
  const auto now = start + milliseconds(9900);
  EXPECT_EQ(statistics.total(), 100u);
  EXPECT_EQ(statistics.recent(now), 51u);
  EXPECT_NEAR(statistics.rate_hz(now), 10.0, 1e-9);
  EXPECT_EQ(statistics.recent(now + seconds(3)), 21u);
  EXPECT_EQ(statistics.recent(now + seconds(6)), 0u);
  EXPECT_EQ(statistics.rate_hz(now + seconds(6)), 0.0);
}

TEST(TopicStatisticsTest, AFloodIsBounded) {
  TopicStatistics statistics;
  for (int i = 0; i < 100000; ++i) statistics.add(TopicStatistics::Time());
  EXPECT_LE(statistics.recent(TopicStatistics::Time()), 2000u);
  EXPECT_EQ(statistics.rate_hz(TopicStatistics::Time()), 0.0);
}

TEST(TopicStatisticsTest, ARunEndsWithASilence) {
  TopicStatistics statistics;
  const TopicStatistics::Time start;
  for (int i = 0; i < 10; ++i) statistics.add(start + i * milliseconds(100));
  EXPECT_EQ(statistics.startOfRun(), start);
  for (int i = 40; i < 50; ++i) statistics.add(start + i * milliseconds(100));
  EXPECT_EQ(statistics.startOfRun(), start + seconds(4));
  EXPECT_EQ(statistics.since(statistics.startOfRun()), 10u);
}

/// Of a rig that is well.
InputReport soundReport() {
  InputReport report;
  int i = 0;
  static const char* const kTopics[] = {"/l/image", "/r/image", "/l/info", "/r/info"};
  for (TopicReport* topic :
       {&report.left_image, &report.right_image, &report.left_info, &report.right_info}) {
    *topic = {kTopics[i++], 1, 50, 500, 10.0, 0.05};
  }
  report.max_stamp_difference_s = report.tolerance_s = 0.01;
  report.period_s = 0.1;
  report.pairs_silent_s = 0.05;
  report.unmatched = {0, 0, 50};
  report.stamp_difference_s = 0.0;
  report.recent_pairs = 50;
  return report;
}

struct Case {
  std::function<void(InputReport&)> change;
  std::string said;  // in full, or the beginning of it
};

void expectSaid(std::string (*say)(const InputReport&), const std::vector<Case>& cases) {
  for (const auto& [change, said] : cases) {
    InputReport report = soundReport();
    change(report);
    EXPECT_EQ(say(report).substr(0, said.empty() ? std::string::npos : said.size()), said);
  }
}

TEST(InputReportTest, SaysWhyATopicIsSilent) {
  // Before the window of the counts has passed.
  const auto stop = [](InputReport& report) {
    report.left_image.recent = report.right_image.recent = 25;
    report.left_image.silent_s = report.right_image.silent_s = 2.31;
  };
  expectSaid(
      whyNoPairs,
      {{[](InputReport&) {}, ""},
       {[](InputReport& report) { report.right_image = {"/r/image"}; },
        "nobody publishes /r/image: start the driver, or remap it"},
       {[](InputReport& report) { report.right_image.publishers = report.right_image.recent = 0; },
        "nobody publishes /r/image any more: has the bag ended or the driver stopped?"},
       {[](InputReport& report) { report.left_image.recent = 0; },
        "/l/image has a publisher, but no messages arrive"},
       {stop, "/l/image has been silent for 2.3 s: has the driver or the connection stopped?"},
       {[&](InputReport& report) {
          stop(report);
          report.left_image.publishers = 0;
        },
        "nobody publishes /l/image any more"},
       {[&](InputReport& report) {
          stop(report);
          report.left_image.silent_s = 0.9;
        },
        "/r/image has been silent for 2.3 s"},
       {[&](InputReport& report) {  // not silent, but slow
          stop(report);
          report.left_image.rate_hz = report.right_image.rate_hz = 0.5;
        },
        ""},
       {[&](InputReport& report) {
          stop(report);
          report.clock_stands = true;
        },
        "/clock stands still: the replay is paused or has ended"},
       {[](InputReport& report) {
          report.waits_for_info = true;
          report.right_info.total = report.right_info.publishers = 0;
        },
        "nobody publishes /r/info"},
       {[](InputReport& report) { report.camera_error = "the baseline is zero"; },
        "the baseline is zero"},
       {[](InputReport& report) {
          report.recent_pairs = 0;
          report.refused = "the left image has the stamp 0";
        },
        "the left image has the stamp 0"}});
}

TEST(InputReportTest, SaysWhyStampsAreNoPairs) {
  const auto apart = [](double difference_s, std::optional<double> skew_of_a_period_s = {}) {
    return [=](InputReport& report) {
      report.recent_pairs = 0;
      report.stamp_difference_s = difference_s;
      report.skew_of_a_period_s = skew_of_a_period_s;
    };
  };
  expectSaid(
      whyNoPairs,
      {{apart(0.02),
        "left and right stamps are up to 20 ms apart, more than max_stamp_difference_s = 10 ms: "
        "trigger the cameras synchronously, or set max_stamp_difference_s to 0.024"},
       {apart(0.03),  // whoever set the parameter would get pairs of different times
        "left and right stamps are up to 30 ms apart, more than 10 ms and 30 % of the period of "
        "100 ms: trigger the cameras synchronously; with a larger max_stamp_difference_s, images "
        "of different times would be pairs"},
       {apart(0.02, -0.08),
        "right stamps are 80 ms before the left ones with the same jitter, about a period"},
       {apart(3.1),
        "left and right stamps are up to 3.1e+03 ms apart, more than max_stamp_difference_s = 10 "
        "ms: are both topics from the same rig, and the clocks of both drivers synchronized?"}});
}

TEST(InputReportTest, SaysWhatIsWrongWithPairs) {
  const auto received = [](double left_hz, double right_hz, auto unmatched) {
    return [=](InputReport& report) {
      report.left_image.rate_hz = left_hz;
      report.right_image.rate_hz = right_hz;
      report.unmatched = unmatched;
    };
  };
  const auto aged = [](double age_s) {
    return [=](InputReport& report) { report.stamp_age_s = age_s; };
  };
  using Unmatched = decltype(InputReport::unmatched);
  expectSaid(
      faultOfPairs,
      {{[](InputReport&) {}, ""},
       {[](InputReport& report) { report.median_skew_s = 0.02; }, ""},
       {[](InputReport& report) { report.median_skew_s = -0.03; },
        "left and right stamps are 30 ms apart, 30 % of the period of 100 ms, so it is not sure "
        "which images are of one time: trigger the cameras synchronously"},
       {[](InputReport& report) {
          report.median_skew_s = -0.03;
          report.skew_of_a_period_s = 0.1;
        },
        "right stamps are 100 ms after the left ones with the same jitter, about a period, so "
        "images of different times have the nearest stamps: correct the stamps of the drivers"},
       {received(10.0, 7.0, Unmatched{15, 0, 35}),
        "30 % of the images have no partner: /l/image arrives at 10.0 Hz, /r/image at 7.0 Hz: "
        "the camera of /r/image or its connection loses images"},
       {received(7.0, 7.0, Unmatched{11, 10, 25}),
        "30 % of the images have no partner: /l/image arrives at 7.0 Hz, /r/image at 7.0 Hz: "
        "both lose images, or stamps are more than 10 ms apart"},
       {aged(0.9), ""},
       {aged(-0.1), ""},
       {aged(20.0),
        "the stamps of /l/image are 20.0 s behind the clock when the images arrive: synchronise "
        "the clocks of camera and computer"},
       {aged(-3.0),
        "the stamps of /l/image are 3.0 s ahead of the clock, and so are odometry and tf, which "
        "others cannot use yet: synchronise the clocks of camera and computer"},
       {aged(1e8), ""},  // a replay without /clock
       {received(10.0, 10.0, Unmatched{4, 0, 46}), ""},
       {received(10.0, 10.0, Unmatched{50, 0, 950}), ""},
       {received(10.0, 10.0, Unmatched{3, 0, 1}), ""}});  // at a start
}

TEST(InputReportTest, TopicsAreToldInOneLine) {
  InputReport report = soundReport();
  report.right_image.recent = 0;
  report.right_image.rate_hz = 0.0;
  report.stamp_difference_s = 0.0034;
  EXPECT_EQ(describeTopics(report),
            "/l/image 50 (10.0 Hz), /r/image 0, /l/info 50 (10.0 Hz), /r/info 50 (10.0 Hz); "
            "stamps of left and right differ by at most 3.4 ms");
}

}  // namespace
}  // namespace rotrocc
