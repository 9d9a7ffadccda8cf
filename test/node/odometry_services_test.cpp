// The services beside each other; the actions are the test's.

#include "node/odometry_services.h"

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include "support/service_caller.h"

namespace rotrocc {
namespace {

TEST(OdometryServicesTest, NothingWaitsForASave) {
  ros::AsyncSpinner spinner(1);  // of the images and the other services
  spinner.start();
  std::atomic<bool> saving{false};
  std::atomic<bool> was_reset{false};
  OdometryServices::Actions actions;
  actions.reset = [&] { was_reset = true; };
  actions.save_trajectory = [&](const std::string&, const std::string&) -> std::string {
    saving = true;
    if (!waitUntil([&] { return was_reset.load(); })) throw std::runtime_error("nothing else ran");
    return "wrote 1 pose";
  };
  ros::NodeHandle nh("~");
  const OdometryServices services(nh, actions);

  ServiceCaller caller(nh.getNamespace());
  SaveTrajectory save;
  std::thread saver([&] { ServiceCaller(nh.getNamespace()).call("save_trajectory", save); });
  ASSERT_TRUE(waitUntil([&] { return saving.load(); }));
  std_srvs::Trigger reset;
  EXPECT_TRUE(caller.call("reset", reset));
  EXPECT_TRUE(reset.response.success);
  saver.join();
  EXPECT_TRUE(save.response.success) << save.response.message;
}

/// Of the tests themselves.
TEST(ServiceCallerTest, EndsACallWithoutReply) {
  ros::AsyncSpinner spinner(1);
  spinner.start();
  std::atomic<bool> replies{false};
  OdometryServices::Actions actions;
  actions.save_trajectory = [&](const std::string&, const std::string&) -> std::string {
    waitUntil([&] { return replies.load(); });
    return "wrote 1 pose";
  };
  ros::NodeHandle nh("~");
  const OdometryServices services(nh, actions);

  ServiceCaller caller(nh.getNamespace(), std::chrono::milliseconds(300));
  SaveTrajectory save;
  EXPECT_FALSE(caller.call("save_trajectory", save));
  replies = true;
  EXPECT_TRUE(waitUntil([&] { return caller.call("save_trajectory", save); }));
  EXPECT_TRUE(save.response.success) << save.response.message;
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "odometry_services_test");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
