#include "stress/answer_audit.h"

#include <cmath>

#include <gtest/gtest.h>

#include "stress/fault_injector.h"

namespace rotrocc {
namespace {

nav_msgs::Odometry soundOdometry() {
  nav_msgs::Odometry odometry;
  odometry.pose.pose.orientation.w = 1.0;
  odometry.pose.covariance[0] = 0.1;
  return odometry;
}

TEST(IsSoundTest, TellsNonsense) {
  EXPECT_TRUE(isSound(soundOdometry()));
  EXPECT_FALSE(isSound({})) << "a quaternion of zeros";
  nav_msgs::Odometry odometry = soundOdometry();
  odometry.pose.pose.position.z = NAN;
  EXPECT_FALSE(isSound(odometry));
  odometry = soundOdometry();
  odometry.pose.pose.orientation.w = NAN;
  EXPECT_FALSE(isSound(odometry));
  odometry = soundOdometry();
  odometry.twist.covariance[7] = -1e-9;
  EXPECT_FALSE(isSound(odometry));
  odometry = soundOdometry();
  odometry.pose.covariance[1] = INFINITY;
  EXPECT_FALSE(isSound(odometry));
}

TEST(ImageAccountTest, EachImageIsUsedOrDroppedForAReason) {
  ImageAccount images;
  images.sent = 100;
  images.received = 96;
  images.used = 90;
  images.dropped = {{"no_partner", 2}, {"image_data", 2}};
  EXPECT_FALSE(images.addsUp()) << "two are missing";
  images.dropped["paused"] = 2;
  EXPECT_TRUE(images.addsUp());
  images.sent = 95;
  EXPECT_FALSE(images.addsUp()) << "more than sent";
}

TEST(ImageAccountTest, KnowsWhatADropIs) {
  EXPECT_EQ(imagesPerDrop("camera_info_invalid"), 0u);
  EXPECT_EQ(imagesPerDrop("stamp_future"), 1u);
  EXPECT_EQ(imagesPerDrop("no_partner"), 1u);
  EXPECT_EQ(imagesPerDrop("camera_info_missing"), 2u);
  EXPECT_EQ(imagesPerDrop("image_size"), 2u);
}

TEST(FaultInjectorTest, SameSeedMakesTheSameFaults) {
  std::map<std::string, std::uint64_t> counts[2];
  for (auto& count : counts) {
    FaultInjector injector(0.5, 3);
    for (int i = 0; i < 4000; ++i) {
      StressPair pair;
      pair.left.data.resize(16);
      injector.apply(pair);
    }
    count = injector.counts();
  }
  EXPECT_EQ(counts[0], counts[1]);
  EXPECT_EQ(counts[0].size(), 24u) << "every fault occurs";
}

TEST(FaultInjectorTest, InTurnEachFaultOccursOnce) {
  FaultInjector injector(1);
  int lost_right = 0;
  for (int i = 0; i < 300; ++i) {
    StressPair pair;
    const bool may_begin = i % 2 == 1;
    injector.apply(pair, may_begin);
    lost_right += !pair.send_right;
  }
  EXPECT_TRUE(injector.finished());
  EXPECT_EQ(injector.counts().size(), 24u);
  for (const auto& [fault, count] : injector.counts()) EXPECT_EQ(count, 1u) << fault;
  EXPECT_GT(lost_right, 5) << "30 % of a stretch";
  EXPECT_LT(lost_right, 16);
  StressPair pair;
  EXPECT_FALSE(injector.apply(pair));
}

TEST(FaultInjectorTest, NoShareNoFault) {
  FaultInjector injector(0.0, 1);
  for (int i = 0; i < 100; ++i) {
    StressPair pair;
    injector.apply(pair);
  }
  EXPECT_TRUE(injector.counts().empty());
}

}  // namespace
}  // namespace rotrocc
