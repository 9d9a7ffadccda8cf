// The services beside each other.

#include <atomic>
#include <stdexcept>
#include <thread>

#include <std_srvs/Trigger.h>

#include "node/odometry_services.h"
#include "nodelet_drive.h"
#include "rotrocc/SaveTrajectory.h"

namespace rotrocc {
namespace {

TEST(ServicesTest, NothingWaitsForASave) {
  ros::NodeHandle nh("~");
  PairProcessor processor{Parameters()};
  OdometryHealth health;
  std::atomic<bool> saving{false};
  std::atomic<bool> was_reset{false};
  const auto save = [&](const std::string&, const std::string&) -> std::string {
    saving = true;
    if (!waitUntil([&] { return was_reset.load(); })) throw std::runtime_error("nothing else ran");
    return "wrote 1 pose";
  };
  const OdometryServices services(nh, processor, health, save, "odom");
  SaveTrajectory saved;
  std::thread saver([&] { ServiceCaller(nh.getNamespace()).call("save_trajectory", saved); });
  ASSERT_TRUE(waitUntil([&] { return saving.load(); }));
  std_srvs::Trigger reset;
  EXPECT_TRUE(ServiceCaller(nh.getNamespace()).call("reset", reset));
  EXPECT_TRUE(reset.response.success);
  was_reset = true;
  saver.join();
  EXPECT_TRUE(saved.response.success) << saved.response.message;
}

}  // namespace
}  // namespace rotrocc
