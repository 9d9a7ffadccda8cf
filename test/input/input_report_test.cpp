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
  for (int i = 0; i < 100; ++i) statistics.add(i, start + i * milliseconds(100));
  const auto now = start + milliseconds(9900);
  EXPECT_EQ(statistics.total(), 100u);
  EXPECT_EQ(statistics.recent(now), 51u);
  EXPECT_NEAR(statistics.rate_hz(now), 10.0, 1e-9);
  EXPECT_EQ(statistics.recent(now + seconds(3)), 21u);
  EXPECT_EQ(statistics.recent(now + seconds(6)), 0u);
  EXPECT_EQ(statistics.rate_hz(now + seconds(6)), 0.0);
  EXPECT_EQ(statistics.lastStamps_ns().size(), 16u);
  EXPECT_EQ(statistics.lastStamps_ns().back(), 99);
}

TEST(TopicStatisticsTest, AFloodIsBounded) {
  TopicStatistics statistics;
  for (int i = 0; i < 100000; ++i) statistics.add(i, TopicStatistics::Time());
  EXPECT_LE(statistics.recent(TopicStatistics::Time()), 2000u);
  EXPECT_EQ(statistics.rate_hz(TopicStatistics::Time()), 0.0);
}

TEST(StampDifferenceTest, IsThatToTheNearest) {
  EXPECT_FALSE(greatestStampDifference({}, {1}));
  EXPECT_FALSE(greatestStampDifference({1}, {}));
  const auto difference_s =
      greatestStampDifference({0, 100'000'000, 200'000'000}, {3'000'000, 104'000'000, 250'000'000});
  ASSERT_TRUE(difference_s);
  EXPECT_NEAR(*difference_s, 0.050, 1e-12);
}

TEST(StampDifferenceTest, PartnersThatAreStillToComeDoNotCount) {
  EXPECT_EQ(greatestStampDifference({0, 100'000'000, 200'000'000}, {0, 100'000'000}), 0.0);
}

TEST(StampDifferenceTest, ClocksThatDifferAreFarApart) {
  EXPECT_NEAR(
      *greatestStampDifference({0, 100'000'000}, {3'000'000'000, 4'000'000'000}), 2.9, 1e-12);
}

class WhyNoPairsTest : public testing::Test {
 protected:
  WhyNoPairsTest() {
    int i = 0;
    static const char* const kTopics[] = {"/l/image", "/r/image", "/l/info", "/r/info"};
    for (TopicReport* topic :
         {&report_.left_image, &report_.right_image, &report_.left_info, &report_.right_info}) {
      *topic = {kTopics[i++], 1, 50, 500, 10.0};
    }
    report_.max_stamp_difference_s = 0.01;
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

TEST_F(WhyNoPairsTest, SkewOfAParameter) {
  report_.recent_pairs = 0;
  report_.stamp_difference_s = 0.03;
  expectSaid(
      "left and right stamps are up to 30 ms apart, more than max_stamp_difference_s = "
      "10 ms: trigger the cameras synchronously, or set max_stamp_difference_s to 0.036");
}

TEST_F(WhyNoPairsTest, ClocksThatDiffer) {
  report_.recent_pairs = 0;
  report_.stamp_difference_s = 3.1;
  expectSaid("the clocks of both drivers synchronized?");
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
