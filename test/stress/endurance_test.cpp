// A drive with each fault of scripts/soak once, the next one after the recovery from the one
// before.

#include <cmath>
#include <utility>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include "stress/stress_player.h"
#include "support/synthetic_sequence.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

TEST(EnduranceTest, KnowsSoundAnswersAndAccounts) {
  nav_msgs::Odometry sound;
  EXPECT_FALSE(isSound(sound)) << "a quaternion of zeros";
  sound.pose.pose.orientation.w = 1.0;
  EXPECT_TRUE(isSound(sound));
  for (double* value : {&sound.pose.pose.position.z,
                        &sound.pose.pose.orientation.w,
                        &sound.pose.covariance[1],
                        &sound.twist.covariance[7]}) {
    const double before = std::exchange(*value, NAN);
    EXPECT_FALSE(isSound(sound));
    *value = before;
  }
  sound.twist.covariance[7] = -1e-9;
  EXPECT_FALSE(isSound(sound));

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

TEST(EnduranceTest, EveryFaultIsToldCountedAndOver) {
  const TemporaryDirectory directory;
  StressOptions options;
  options.recording = directory / "drive";
  options.rate_hz = 30.0;
  options.duration_s = 600.0;  // only against hanging
  options.in_turn = true;
  writeSyntheticSequence(options.recording, 30);
  ros::NodeHandle nh;
  StressPlayer player(nh, options);
  EXPECT_TRUE(player.run()) << "see the report above";
  EXPECT_TRUE(player.faults().finished()) << "no recovery from a fault";
  EXPECT_TRUE(player.audit().recovered());
  const auto dropped = player.audit().images().dropped;
  for (const char* reason : {"no_partner", "tf_missing", "stamp_zero", "image_data"}) {
    EXPECT_EQ(dropped.count(reason), 1u) << reason;
  }
  for (const char* words : {"no tf from base_link to stress_camera",
                            "a frame has only one parent",
                            "it is a FIFO",
                            "time jumped back"}) {
    EXPECT_TRUE(player.audit().logged(words)) << words;
  }
}

}  // namespace
}  // namespace rotrocc
