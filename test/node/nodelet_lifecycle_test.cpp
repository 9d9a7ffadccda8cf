// The nodelet is loaded and unloaded repeatedly, and must not disturb another one in the same
// manager. The node is stopped at any moment.

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nodelet/NodeletLoad.h>
#include <nodelet/NodeletUnload.h>
#include <nodelet/nodelet.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>
#include <pluginlib/class_loader.hpp>

#include "support/background_command.h"
#include "support/read_file.h"
#include "support/run_command.h"
#include "support/service_caller.h"
#include "support/simulated_robot.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kRounds = 50;

/// Sends images to the other nodelet, and counts its answers.
class Canary {
 public:
  Canary() {
    ros::NodeHandle nh;
    image_publisher_ = nh.advertise<sensor_msgs::Image>("canary/image", 10);
    subscriber_ = nh.subscribe<sensor_msgs::Image>(
        "canary/answer", 10, [this](const sensor_msgs::Image::ConstPtr&) { ++answers_; });
  }

  /// Whether it answers.
  bool sings() {
    const int before = answers_;
    return waitUntil([&] {
      ask();
      std::this_thread::sleep_for(milliseconds(20));
      return answers_ > before;
    });
  }

 private:
  void ask() {
    sensor_msgs::Image image;
    image.header.stamp = ros::Time(1000 + ++asked_);
    image.encoding = sensor_msgs::image_encodings::MONO8;
    image.width = image.height = image.step = 32;
    image.data.resize(32 * 32);
    image_publisher_.publish(image);
  }

  std::uint32_t asked_ = 0;
  std::atomic<int> answers_{0};
  ros::Publisher image_publisher_;
  ros::Subscriber subscriber_;
};

class NodeletLifecycleTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(canary_.sings()); }

  bool load(const std::map<std::string, std::string>& remappings = {}) {
    nodelet::NodeletLoad service;
    for (const auto& [name, target] : remappings) {
      service.request.remap_source_args.push_back(name);
      service.request.remap_target_args.push_back(target);
    }
    service.request.name = "/stereo_odometry";
    service.request.type = "rotrocc/StereoOdometry";
    return manager_.call("load_nodelet", service) && service.response.success;
  }

  bool unload() {
    nodelet::NodeletUnload service;
    service.request.name = "/stereo_odometry";
    return manager_.call("unload_nodelet", service) && service.response.success;
  }

  ServiceCaller manager_{"manager"};
  Canary canary_;
};

/// Drives until there is odometry with a motion.
bool answers(SimulatedRobot& robot) {
  robot.publishMount();
  return waitUntil([&] {
    robot.publishInfos();
    const auto status = robot.statusOf(robot.drive(), seconds(5));
    return status && status->state == OdometryStatus::OK;
  });
}

TEST_F(NodeletLifecycleTest, LoadsAndUnloadsWhileImagesCome) {
  ASSERT_TRUE(load());
  SimulatedRobot robot;
  ASSERT_TRUE(answers(robot));
  std::atomic<bool> done{false};
  std::thread driver([&] {
    while (!done) {
      robot.publishInfos();
      robot.drive();
      std::this_thread::sleep_for(milliseconds(20));
    }
  });
  ASSERT_TRUE(unload());
  for (int i = 0; i < kRounds; ++i) {
    ASSERT_TRUE(load()) << "round " << i;
    // Sometimes at once, sometimes while it works.
    std::this_thread::sleep_for(milliseconds(i % 5 * 20));
    ASSERT_TRUE(unload()) << "round " << i;
    if (i % 10 == 0) {
      ASSERT_TRUE(canary_.sings()) << "round " << i;
    }
  }
  done = true;
  driver.join();
  ASSERT_TRUE(canary_.sings());
  ASSERT_TRUE(load());
  EXPECT_TRUE(answers(robot));
  EXPECT_TRUE(unload());
}

/// Those of a manager do not come for messages that arrive while the nodelet starts.
TEST_F(NodeletLifecycleTest, NeedsNoCallbacksOfItsManager) {
  ros::CallbackQueue disabled(false);
  pluginlib::ClassLoader<nodelet::Nodelet> plugins("nodelet", "nodelet::Nodelet");
  const auto odometry = plugins.createUniqueInstance("rotrocc/StereoOdometry");
  odometry->init("/stereo_odometry", {}, {}, &disabled, &disabled);
  SimulatedRobot robot;
  EXPECT_TRUE(answers(robot));
}

/// What makes the nodelet fail while it starts.
struct Obstacle {
  std::string phase;
  std::map<std::string, std::string> parameters;  // of the nodelet
  std::map<std::string, std::string> remappings;  // to what the other nodelet or the manager has
};

/// In the order in which the nodelet starts.
std::vector<Obstacle> obstacles() {
  return {
      {"unknown parameter", {{"no_such", "1"}}, {}},
      {"frame", {{"base_frame", "/base_link"}}, {}},
      {"odom", {}, {{"odom", "canary/answer"}}},
      {"twist", {}, {{"twist", "canary/answer"}}},
      {"status", {}, {{"status", "canary/answer"}}},
      {"path", {}, {{"path", "canary/answer"}}},
      {"inliers", {}, {{"inliers", "canary/answer"}}},
      {"trajectory file", {{"trajectory_file", "/no/such/directory/poses.txt"}}, {}},
      {"left camera_info", {}, {{"left/camera_info", "canary/image"}}},
      {"right camera_info", {}, {{"right/camera_info", "canary/image"}}},
      {"image transport", {{"image_transport", "no_such"}}, {}},
      {"left image", {}, {{"left/image_rect", "canary/camera_info"}}},
      {"right image", {}, {{"right/image_rect", "canary/camera_info"}}},
      {"reset", {}, {{"stereo_odometry/reset", "manager/list"}}},
      {"save_trajectory", {}, {{"stereo_odometry/save_trajectory", "manager/list"}}},
      {"parameter descriptions", {}, {{"stereo_odometry/parameter_descriptions", "canary/answer"}}},
      {"parameter service", {}, {{"stereo_odometry/set_parameters", "manager/list"}}},
  };
}

TEST_F(NodeletLifecycleTest, FailsToStartAloneInAnyPhase) {
  const ros::NodeHandle private_nh("stereo_odometry");
  for (const Obstacle& obstacle : obstacles()) {
    SCOPED_TRACE(obstacle.phase);
    for (const auto& [name, value] : obstacle.parameters) private_nh.setParam(name, value);
    ASSERT_FALSE(load(obstacle.remappings));
    for (const auto& [name, value] : obstacle.parameters) private_nh.deleteParam(name);
    ASSERT_TRUE(canary_.sings());
  }
  // Without any image transport there is no picture of the flow.
  const std::string blacklist = "flow/disable_pub_plugins";
  ros::param::set(blacklist, std::vector<std::string>{"image_transport/raw"});
  EXPECT_FALSE(load());
  ros::param::del(blacklist);
  ASSERT_TRUE(canary_.sings());

  ASSERT_TRUE(load()) << "nothing is left of those that failed";
  SimulatedRobot robot;
  EXPECT_TRUE(answers(robot));
  EXPECT_TRUE(unload());
}

TEST(NodeTest, EndsWithTheReasonIfItCannotStart) {
  const CommandResult result = runCommand("timeout -k 180 180 " STEREO_ODOMETRY
                                          " __name:=without_transport _image_transport:=no_such");
  EXPECT_EQ(result.status, 1) << result.output;
  EXPECT_NE(result.output.find("/without_transport: image_transport is no_such, but this machine "
                               "only has image_transport/raw: install its plugin"),
            std::string::npos)
      << result.output;
}

TEST(NodeTest, EndsCleanlyAtAnyMoment) {
  for (int i = 0; i < 12; ++i) {
    const std::string delay_s = std::to_string(0.05 + 0.1 * i);
    ros::param::set("/use_sim_time", i % 2 == 1);  // without a clock: time stands still
    const CommandResult result = runCommand("timeout --preserve-status -k 180 -s INT " + delay_s +
                                            " " STEREO_ODOMETRY " __name:=short_lived");
    // 130: before ROS has taken over the signal.
    EXPECT_TRUE(result.status == 0 || result.status == 130)
        << "status " << result.status << " after " << delay_s << " s: " << result.output;
  }
  ros::param::set("/use_sim_time", false);
}

}  // namespace
}  // namespace rotrocc
