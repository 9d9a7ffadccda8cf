#include "input/input_report.h"

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

class WhyNoPairsTest : public testing::Test {
 protected:
  WhyNoPairsTest() {
    int i = 0;
    static const char* const kTopics[] = {"/l/image", "/r/image", "/l/info", "/r/info"};
    for (TopicReport* topic :
         {&report_.left_image, &report_.right_image, &report_.left_info, &report_.right_info}) {
      *topic = {kTopics[i++], 1, 50, 500, 10.0, 0.05};
    }
    report_.max_stamp_difference_s = report_.tolerance_s = 0.01;
    report_.period_s = 0.1;
    report_.pairs_silent_s = 0.05;
    report_.together = {50, 50, 50};
    report_.stamp_difference_s = 0.0;
    report_.recent_pairs = 50;
  }

  void expectSaid(const std::string& part) const {
    EXPECT_NE(whyNoPairs(report_).find(part), std::string::npos) << whyNoPairs(report_);
  }

  InputReport report_;
};

TEST_F(WhyNoPairsTest, NothingIsSaidIfAllIsWell) {
  EXPECT_EQ(whyNoPairs(report_), "");
}

TEST_F(WhyNoPairsTest, TopicWithoutPublisher) {
  report_.right_image = {"/r/image"};
  expectSaid("nobody publishes /r/image: start the driver, or remap it");
}

TEST_F(WhyNoPairsTest, TopicWhosePublisherIsGone) {
  report_.right_image.publishers = report_.right_image.recent = 0;
  expectSaid("nobody publishes /r/image any more: has the bag ended or the driver stopped?");
}

TEST_F(WhyNoPairsTest, PublisherThatSendsNothing) {
  report_.left_image.recent = 0;
  expectSaid("/l/image has a publisher, but no messages arrive");
}

/// Before the window of the counts has passed.
TEST_F(WhyNoPairsTest, TopicThatHasJustStopped) {
  report_.left_image.recent = report_.right_image.recent = 25;
  report_.left_image.silent_s = report_.right_image.silent_s = 2.31;
  expectSaid("/l/image has been silent for 2.3 s: has the driver or the connection stopped?");
  report_.left_image.publishers = 0;
  expectSaid("nobody publishes /l/image any more");
  report_.left_image.silent_s = 0.9;
  expectSaid("/r/image has been silent for 2.3 s");
}

TEST_F(WhyNoPairsTest, SlowTopicsAreNotSilent) {
  report_.left_image.rate_hz = report_.right_image.rate_hz = 0.5;
  report_.left_image.silent_s = report_.right_image.silent_s = 2.3;
  EXPECT_EQ(whyNoPairs(report_), "");
}

TEST_F(WhyNoPairsTest, SkewOfAParameter) {
  report_.recent_pairs = 0;
  report_.stamp_difference_s = 0.02;
  expectSaid(
      "left and right stamps are up to 20 ms apart, more than max_stamp_difference_s = "
      "10 ms: trigger the cameras synchronously, or set max_stamp_difference_s to 0.024");
}

/// Whoever did as advised would get pairs of different times.
TEST_F(WhyNoPairsTest, SkewOfALargePartOfThePeriodIsNotToBeAccepted) {
  report_.recent_pairs = 0;
  report_.stamp_difference_s = 0.03;
  expectSaid(
      "left and right stamps are up to 30 ms apart, more than 10 ms and 30 % of the period of "
      "100 ms: trigger the cameras synchronously; with a larger max_stamp_difference_s, images of "
      "different times would be pairs");
  EXPECT_EQ(whyNoPairs(report_).find("set max_stamp_difference_s"), std::string::npos);
}

TEST_F(WhyNoPairsTest, SkewOfAPeriod) {
  report_.recent_pairs = 0;
  report_.stamp_difference_s = 0.02;
  report_.skew_of_a_period_s = -0.08;
  expectSaid("right stamps are 80 ms before the left ones with the same jitter, about a period");
}

TEST_F(WhyNoPairsTest, FaultsOfPairsAreTold) {
  EXPECT_EQ(faultOfPairs(report_), "");
  report_.median_skew_s = 0.02;
  EXPECT_EQ(faultOfPairs(report_), "");
  report_.median_skew_s = -0.03;
  EXPECT_EQ(faultOfPairs(report_),
            "left and right stamps are 30 ms apart, 30 % of the period of 100 ms, so it is not "
            "sure which images are of one time: trigger the cameras synchronously");
  report_.skew_of_a_period_s = 0.1;
  EXPECT_EQ(faultOfPairs(report_),
            "right stamps are 100 ms after the left ones with the same jitter, about a period, so "
            "images of different times have the nearest stamps: correct the stamps of the drivers");
}

TEST_F(WhyNoPairsTest, LostImagesAreTold) {
  report_.right_image.rate_hz = 7.0;
  report_.together = {50, 35, 35};
  EXPECT_EQ(faultOfPairs(report_),
            "30 % of the images have no partner: /l/image arrives at 10.0 Hz, /r/image at 7.0 Hz: "
            "the camera of /r/image or its connection loses images");
  report_.left_image.rate_hz = 7.0;
  report_.together = {36, 35, 25};
  EXPECT_EQ(faultOfPairs(report_),
            "30 % of the images have no partner: /l/image arrives at 7.0 Hz, /r/image at 7.0 Hz: "
            "both lose images, or stamps are more than 10 ms apart");
}

TEST_F(WhyNoPairsTest, FewLostImagesAreNoFault) {
  report_.together = {50, 46, 46};
  EXPECT_EQ(faultOfPairs(report_), "");
  report_.together = {1000, 950, 950};
  EXPECT_EQ(faultOfPairs(report_), "");
  report_.together = {4, 1, 1};  // at a start
  EXPECT_EQ(faultOfPairs(report_), "");
}

TEST_F(WhyNoPairsTest, ClocksThatDiffer) {
  report_.recent_pairs = 0;
  report_.stamp_difference_s = 3.1;
  expectSaid("the clocks of both drivers synchronized?");
}

TEST_F(WhyNoPairsTest, ReplaysThatEnded) {
  report_.left_image.silent_s = report_.right_image.silent_s = 9.0;
  report_.clock_stands = true;
  expectSaid("/clock stands still: the replay is paused or has ended");
}

TEST_F(WhyNoPairsTest, CameraInfoThatIsMissing) {
  report_.waits_for_info = true;
  report_.right_info.total = report_.right_info.publishers = 0;
  expectSaid("nobody publishes /r/info");
}

TEST_F(WhyNoPairsTest, CameraInfoThatIsBad) {
  report_.camera_error = "the baseline is zero";
  expectSaid("the baseline is zero");
}

TEST_F(WhyNoPairsTest, ImagesThatAreRefused) {
  report_.recent_pairs = 0;
  report_.refused = "the left image has the stamp 0";
  expectSaid("the left image has the stamp 0");
}

TEST_F(WhyNoPairsTest, TopicsAreToldInOneLine) {
  report_.right_image.recent = 0;
  report_.right_image.rate_hz = 0.0;
  report_.stamp_difference_s = 0.0034;
  EXPECT_EQ(describeTopics(report_),
            "/l/image 50 (10.0 Hz), /r/image 0, /l/info 50 (10.0 Hz), /r/info 50 (10.0 Hz); "
            "stamps of left and right differ by at most 3.4 ms");
}

}  // namespace
}  // namespace rotrocc
