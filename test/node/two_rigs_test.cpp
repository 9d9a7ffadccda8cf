// Two odometries in one manager that publish the same tf, and rivals elsewhere.

#include <map>
#include <mutex>
#include <set>
#include <string>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <nodelet/NodeletUnload.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>
#include <tf2_ros/transform_broadcaster.h>

#include "support/service_caller.h"
#include "support/wait_until.h"

namespace rotrocc {
namespace {

/// The diagnostics of tf by nodelet, and the log.
class Report {
 public:
  Report() {
    diagnostics_ = nh_.subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", 100, [this](const diagnostic_msgs::DiagnosticArray::ConstPtr& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          for (const auto& status : message->status) tf_[status.name] = status.message;
        });
    log_ = nh_.subscribe<rosgraph_msgs::Log>(
        "/rosout", 100, [this](const rosgraph_msgs::Log::ConstPtr& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          said_.insert(message->msg);
        });
  }

  bool says(const std::string& nodelet, const std::string& part) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return tf_[nodelet + ": tf"].find(part) != std::string::npos;
  }

  /// Whether a line of the log begins like that.
  bool logged(const std::string& begin) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = said_.lower_bound(begin);
    return found != said_.end() && found->compare(0, begin.size(), begin) == 0;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::string> tf_;
  std::set<std::string> said_;
  ros::NodeHandle nh_;
  ros::Subscriber diagnostics_, log_;
};

void sendTf(tf2_ros::TransformBroadcaster& broadcaster, const std::string& parent) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.child_frame_id = "base_link";
  transform.transform.rotation.w = 1.0;
  broadcaster.sendTransform(transform);
}

TEST(TwoRigsTest, NameEachOtherAndOtherRivals) {
  Report report;
  EXPECT_TRUE(waitUntil([&] {
    return report.says("front", "/rear publishes tf odom -> base_link as well") &&
           report.says("rear", "/front publishes tf odom -> base_link as well");
  }));
  EXPECT_TRUE(waitUntil([&] {
    return report.logged("/front: no stereo pair") && report.logged("/rear: no stereo pair");
  }));

  nodelet::NodeletUnload unload;
  unload.request.name = "/rear";
  ServiceCaller manager("manager");
  ASSERT_TRUE(manager.call("unload_nodelet", unload));
  EXPECT_TRUE(waitUntil([&] { return report.says("front", "no conflict"); }));

  tf2_ros::TransformBroadcaster broadcaster;
  EXPECT_TRUE(waitUntil([&] {
    sendTf(broadcaster, "map");
    sendTf(broadcaster, "wheel_odom");
    return report.says("front", "/two_rigs publishes tf map -> base_link") &&
           report.logged("/front: /two_rigs publishes tf map -> base_link") &&
           report.logged("/front: /two_rigs publishes tf wheel_odom -> base_link");
  }));
  EXPECT_TRUE(waitUntil([&] { return report.says("front", "no conflict"); }));
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "two_rigs_test");
  const ros::NodeHandle keeps_ros_alive;
  ros::AsyncSpinner spinner(2);
  spinner.start();
  return RUN_ALL_TESTS();
}
