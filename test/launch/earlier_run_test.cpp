// Parameters that an earlier run left on the parameter server.

#include <string>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include "support/run_command.h"

namespace rotrocc {
namespace {

const std::string kNode = "/stereo/stereo_odometry/";

/// Sets a parameter and expects that the node rejects to start, names `cause` and has the command
/// that deletes the parameter, and that this command does so.
template <class T>
void expectRejected(const std::string& parameter, const T& value, const std::string& cause) {
  ros::param::set(kNode + parameter, value);
  const CommandResult node = runCommand(STEREO_ODOMETRY " __ns:=stereo");
  EXPECT_NE(node.status, 0);
  EXPECT_NE(node.output.find(cause), std::string::npos) << node.output;
  const std::string command = "rosparam delete " + kNode + parameter;
  EXPECT_NE(node.output.find(command), std::string::npos) << node.output;
  EXPECT_EQ(runCommand(command).status, 0);
  EXPECT_FALSE(ros::param::has(kNode + parameter));
}

TEST(EarlierRunTest, TheRefusalHasTheCommandThatDeletesTheParameter) {
  expectRejected(
      "feature_detector/max_featurs", 5, "unknown parameter \"feature_detector/max_featurs\"");
  expectRejected("queue_size", 0, "queue_size is 0, but must be in [1, 100]");
  expectRejected("guess_frame", "odom", "guess_frame and odom_frame are both \"odom\"");
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  ros::init(argc, argv, "earlier_run_test");
  const ros::NodeHandle nh;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
