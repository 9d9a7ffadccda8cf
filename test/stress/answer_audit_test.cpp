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

TEST(FaultInjectorTest, SameSeedMakesTheSameFaults) {
  std::map<std::string, std::uint64_t> counts[2];
  for (auto& count : counts) {
    FaultInjector injector(0.5, 3);
    for (int i = 0; i < 2000; ++i) {
      StressPair pair;
      pair.left.data.resize(16);
      injector.apply(pair);
    }
    count = injector.counts();
  }
  EXPECT_EQ(counts[0], counts[1]);
  std::uint64_t total = 0;
  for (const auto& [name, count] : counts[0]) total += count;
  EXPECT_NEAR(static_cast<double>(total), 1000.0, 100.0);
  EXPECT_EQ(counts[0].size(), 18u) << "every fault occurs";
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
