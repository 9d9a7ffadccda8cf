#include "node/odometry_messages.h"

#include <cmath>
#include <functional>
#include <stdexcept>

#include <gtest/gtest.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include "input/input_error.h"
#include "rotrocc/DropCount.h"
#include "support/expect_error.h"

namespace rotrocc {
namespace {

BaseState makeState() {
  BaseState state;
  state.stamp_ns = 3'000'000'004;
  state.T_odom_base.T.translation() << 1, 2, 3;
  state.T_odom_base.T.rotate(Eigen::AngleAxisd(M_PI / 2.0, Eigen::Vector3d::UnitZ()));
  for (int i = 0; i < 36; ++i) state.T_odom_base.covariance(i / 6, i % 6) = i;
  state.twist.twist << 4, 5, 6, 0.1, 0.2, 0.3;
  state.twist.covariance = 7.0 * Matrix6d::Identity();
  return state;
}

TEST(OdometryMessagesTest, OdometryHasPoseTwistAndFrames) {
  const nav_msgs::Odometry message = toOdometry(makeState(), "odom", "base_link");
  EXPECT_EQ(message.header.stamp, ros::Time(3, 4));
  EXPECT_EQ(message.header.frame_id, "odom");
  EXPECT_EQ(message.child_frame_id, "base_link");
  EXPECT_EQ(message.pose.pose.position.y, 2.0);
  EXPECT_NEAR(message.pose.pose.orientation.z, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(message.pose.pose.orientation.w, std::sqrt(0.5), 1e-12);
  for (std::size_t i = 0; i < 36; ++i) EXPECT_EQ(message.pose.covariance[i], i);  // row by row
  EXPECT_EQ(message.twist.twist.linear.z, 6.0);
  EXPECT_EQ(message.twist.twist.angular.x, 0.1);
  EXPECT_EQ(message.twist.covariance[35], 7.0);
}

TEST(OdometryMessagesTest, TwistHasVelocityStampAndFrame) {
  StepVelocity velocity;
  velocity.stamp_ns = 1'500'000'000;
  velocity.twist.twist << 1, 2, 3, 4, 5, 6;
  velocity.twist.covariance = 2.0 * Matrix6d::Identity();
  velocity.twist.covariance(0, 5) = 0.25;
  const geometry_msgs::TwistWithCovarianceStamped message = toTwist(velocity, "base");
  EXPECT_EQ(message.header.stamp, ros::Time(1.5));
  EXPECT_EQ(message.header.frame_id, "base");
  EXPECT_EQ(message.twist.twist.linear.z, 3.0);
  EXPECT_EQ(message.twist.twist.angular.x, 4.0);
  EXPECT_EQ(message.twist.covariance[5], 0.25);
  EXPECT_EQ(message.twist.covariance[35], 2.0);
}

TEST(OdometryMessagesTest, TheDefinitionOfDropCountListsEveryReason) {
  const std::string definition = ros::message_traits::Definition<DropCount>::value();
  for (int i = 0; i < static_cast<int>(DropReason::kCount); ++i) {
    const std::string line = std::string("#   ") + toString(static_cast<DropReason>(i));
    const std::size_t end = definition.find(line) + line.size();
    ASSERT_NE(definition.find(line), std::string::npos) << line;
    EXPECT_TRUE(definition[end] == ' ' || definition[end] == '\n') << line;
  }
}

geometry_msgs::PoseWithCovarianceStamped makePose() {
  geometry_msgs::PoseWithCovarianceStamped message;
  message.header.frame_id = "odom";
  message.pose.pose.position.x = 5.0;
  message.pose.pose.orientation.z = std::sqrt(0.5);
  message.pose.pose.orientation.w = std::sqrt(0.5);
  for (std::size_t axis = 0; axis < 6; ++axis) message.pose.covariance[7 * axis] = 0.5;
  message.pose.covariance[1] = message.pose.covariance[6] = 0.25;
  return message;
}

TEST(OdometryMessagesTest, APoseThatIsSetHasFrameAndCovariance) {
  geometry_msgs::PoseWithCovarianceStamped message = makePose();
  const UncertainTransform pose = toPose(message, "odom");
  EXPECT_TRUE((pose.T * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(5, 1, 0)));
  EXPECT_EQ(pose.covariance(5, 5), 0.5);
  EXPECT_EQ(pose.covariance(0, 1), 0.25);
  message.header.frame_id.clear();
  EXPECT_NO_THROW(toPose(message, "odom"));
  message.pose.covariance.assign(0.0);
  EXPECT_EQ(toPose(message, "odom").covariance.norm(), 0.0);
}

TEST(OdometryMessagesTest, RejectsAPoseThatCannotBeSet) {
  const auto reject =
      [](const std::function<void(geometry_msgs::PoseWithCovarianceStamped&)>& spoil,
         const std::string& part) {
        geometry_msgs::PoseWithCovarianceStamped message = makePose();
        spoil(message);
        expectError<std::invalid_argument>([&] { toPose(message, "odom"); }, part);
      };
  reject([](auto& m) { m.header.frame_id = "map"; }, "in the frame map, but must be in odom");
  reject([](auto& m) { m.pose.pose.orientation.w = 0.0; }, "has the length 0.707");
  reject([](auto& m) { m.pose.pose.position.y = NAN; }, "contains nan");
  reject([](auto& m) { m.pose.covariance[14] = INFINITY; }, "is not finite");
  reject([](auto& m) { m.pose.covariance[1] = 0.1; }, "is not symmetric");
  reject([](auto& m) { m.pose.covariance[0] = -1.0; }, "has the eigenvalue -1.04");
}

TEST(OdometryMessagesTest, CloudHasTheInliersAndTheirGrayLevels) {
  cv::Mat image(10, 20, CV_8UC1, cv::Scalar(0));
  image.at<unsigned char>(4, 7) = 99;
  Correspondences features(3);
  features[1].cur_px = {7.2, 3.9};
  features[1].point_cur = {1.0, -2.0, 30.0};
  features[2].cur_px = {19.9, 4.0};  // tracked to just outside of the image
  std_msgs::Header header;
  header.frame_id = "camera";
  const sensor_msgs::PointCloud2 cloud = toPointCloud(features, {0, 1, 1}, image, header);
  EXPECT_EQ(cloud.header.frame_id, "camera");
  ASSERT_EQ(cloud.width * cloud.height, 2u);
  sensor_msgs::PointCloud2ConstIterator<float> point(cloud, "x");
  EXPECT_EQ(point[0], 1.0f);
  EXPECT_EQ(point[1], -2.0f);
  EXPECT_EQ(point[2], 30.0f);
  sensor_msgs::PointCloud2ConstIterator<float> intensity(cloud, "intensity");
  EXPECT_EQ(*intensity, 99.0f);
  ++intensity;
  EXPECT_EQ(*intensity, 0.0f);
  EXPECT_EQ(toPointCloud(features, {}, image, header).width, 0u);
}

}  // namespace
}  // namespace rotrocc
