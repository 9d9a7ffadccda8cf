// The topics and services of the odometry: one nodelet for all tests, reset before each.

#include <atomic>
#include <chrono>
#include <memory>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include <dynamic_reconfigure/Reconfigure.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <Eigen/Eigenvalues>

#include "nodelet_drive.h"
#include "rotrocc/SaveTrajectory.h"
#include "rotrocc/SetPose.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

using std::chrono::milliseconds;

class InterfaceTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { drive_ = std::make_unique<NodeletDrive>(); }
  static void TearDownTestSuite() { drive_.reset(); }

  /// Drives the first two pairs, whatever state the previous test has left.
  void SetUp() override {
    drive_->setUp();
    std_srvs::SetBool resume;
    std_srvs::Trigger reset;
    ASSERT_TRUE(call("pause", resume));
    ASSERT_TRUE(call("reset", reset));
    first_ = drive();
    ASSERT_EQ(status_.state, OdometryStatus::INITIALIZING);
    recover();
  }

  template <class Service>
  bool call(const std::string& name, Service& service) {
    return drive_->services.call(name, service);
  }

  SimulatedRobot& robot() { return drive_->robot; }

  /// Drives a step and returns its odometry; its status is then in status_.
  nav_msgs::Odometry drive(const std::function<void(sensor_msgs::Image&)>& change = {}) {
    const ros::Time stamp = robot().drive(change);
    status_ = drive_->statusOf(stamp);
    return drive_->odometryOf(stamp);
  }

  /// Drives on until the odometry is OK again.
  void recover() {
    for (int i = 0; i < 5; ++i) {
      drive();
      if (status_.state == OdometryStatus::OK) return;
    }
    FAIL() << "state " << static_cast<int>(status_.state) << ": " << status_.reason;
  }

  static std::uint64_t drops(const std::string& reason, const OdometryStatus& status) {
    for (const DropCount& drop : status.drops) {
      if (drop.reason == reason) return drop.count;
    }
    return 0;
  }
  std::uint64_t drops(const std::string& reason) const { return drops(reason, status_); }

  /// A message on a topic while the robot drives.
  template <class Message>
  boost::shared_ptr<const Message> receive(const std::string& topic) {
    Received<Message> received(topic);
    waitUntil([&] {
      drive();
      return received.last() != nullptr;
    });
    return received.last();
  }

  static std::unique_ptr<NodeletDrive> drive_;
  OdometryStatus status_;
  nav_msgs::Odometry first_;
};

std::unique_ptr<NodeletDrive> InterfaceTest::drive_;

using Array36 = nav_msgs::Odometry::_pose_type::_covariance_type;

double smallestEigenvalue(const Array36& covariance) {
  const Matrix6d matrix = Eigen::Map<const Matrix6d>(covariance.data());
  return Eigen::SelfAdjointEigenSolver<Matrix6d>(matrix).eigenvalues().minCoeff();
}

TEST_F(InterfaceTest, DrivesForwardInAxesOfTheBase) {
  EXPECT_EQ(first_.pose.pose.position.x, 0.0);
  const std::size_t drops_before = status_.drops.size();
  std::uint64_t pairs_processed = status_.pairs_processed;
  constexpr int kSteps = 8;
  double first_variance = 0.0;
  double variance = 0.0;
  for (int i = 2; i <= kSteps; ++i) {
    const nav_msgs::Odometry odometry = drive();
    EXPECT_EQ(status_.state, OdometryStatus::OK) << status_.reason;
    EXPECT_EQ(status_.pairs_processed, ++pairs_processed);
    // 2 % of the short path, and 5 % of the speed.
    const double way_m = i * SimulatedRobot::kStep_m;
    EXPECT_NEAR(odometry.pose.pose.position.x, way_m, 0.02 + 0.02 * way_m);
    EXPECT_NEAR(odometry.pose.pose.position.y, 0.0, 0.02 + 0.02 * way_m);
    EXPECT_NEAR(odometry.pose.pose.position.z, 0.0, 0.02 + 0.02 * way_m);
    const double speed_mps = SimulatedRobot::kStep_m / SimulatedRobot::kPeriod_s;
    EXPECT_NEAR(odometry.twist.twist.linear.x, speed_mps, 0.05 * speed_mps);
    EXPECT_NEAR(odometry.twist.twist.linear.y, 0.0, 0.05 * speed_mps);
    EXPECT_NEAR(odometry.twist.twist.angular.z, 0.0, 0.02);
    EXPECT_GT(smallestEigenvalue(odometry.pose.covariance), 0.0);
    EXPECT_GT(smallestEigenvalue(odometry.twist.covariance), 0.0);
    EXPECT_LT(odometry.twist.covariance[0], 1.0);
    variance = odometry.pose.covariance[0];
    if (i == 2) first_variance = variance;
  }
  // Not from pair to pair: of two measured against one keyframe, the later may be the better.
  EXPECT_GT(variance, first_variance);
  EXPECT_EQ(status_.drops.size(), drops_before);
}

TEST_F(InterfaceTest, StatusReportsThePartsOfTheLatency) {
  const auto begin = std::chrono::steady_clock::now();
  drive();
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - begin;
  const std::vector<float> parts = {status_.waiting_ms,
                                    status_.conversion_ms,
                                    status_.tf_ms,
                                    status_.estimator_ms,
                                    status_.publishing_ms,
                                    status_.overhead_ms};
  for (std::size_t i = 0; i < parts.size(); ++i) EXPECT_GT(parts[i], 0.0f) << i;
  const float rounding = 1e-5f * status_.latency_ms;
  EXPECT_NEAR(std::accumulate(parts.begin(), parts.end(), 0.0f), status_.latency_ms, rounding);
  EXPECT_LE(status_.pyramids_ms + status_.corners_ms + status_.disparity_ms + status_.tracking_ms +
                status_.estimation_ms,
            status_.estimator_ms + status_.prepared_ms + rounding);
  EXPECT_GE(status_.pairing_ms, 0.0f);
  EXPECT_LT(status_.pairing_ms + status_.latency_ms, elapsed.count());
}

TEST_F(InterfaceTest, FindsCornersBeforeThePairArrives) {
  ASSERT_TRUE(waitUntil([&] {  // once the rows of the rig are known, if the keyframe is replaced
    drive();
    return status_.prepared_ms > 0.0f;
  }));
  EXPECT_LE(status_.corners_ms + status_.disparity_ms, status_.prepared_ms);
}

TEST_F(InterfaceTest, TfIsThePoseOfTheOdometry) {
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  nav_msgs::Odometry odometry;
  ASSERT_TRUE(waitUntil([&] {  // the odometry may not know of the new subscriber yet
    odometry = drive();
    return buffer.canTransform("odom", "base_link", odometry.header.stamp, ros::Duration(0.2));
  }));
  const geometry_msgs::TransformStamped transform =
      buffer.lookupTransform("odom", "base_link", odometry.header.stamp);
  constexpr double kRounding = 1e-12;  // tf multiplies transforms
  EXPECT_NEAR(transform.transform.translation.x, odometry.pose.pose.position.x, kRounding);
  EXPECT_NEAR(transform.transform.translation.z, odometry.pose.pose.position.z, kRounding);
  EXPECT_NEAR(transform.transform.rotation.w, odometry.pose.pose.orientation.w, kRounding);
}

TEST_F(InterfaceTest, PicturesComeForSubscribers) {
  const auto path = receive<nav_msgs::Path>("path");
  ASSERT_TRUE(path);
  EXPECT_EQ(path->header.frame_id, "odom");
  EXPECT_EQ(path->poses.front().header.stamp, first_.header.stamp);
  EXPECT_GE(path->poses.size(), 2u) << "the path of the pair before may come late";
  EXPECT_EQ(path->poses.back().header.stamp, path->header.stamp);

  const auto inliers = receive<sensor_msgs::PointCloud2>("inliers");
  ASSERT_TRUE(inliers);
  EXPECT_EQ(inliers->header.frame_id, "camera_left");
  EXPECT_GT(inliers->width, 50u);

  const auto flow = receive<sensor_msgs::Image>("flow");
  ASSERT_TRUE(flow);
  EXPECT_EQ(flow->encoding, "bgr8");
  EXPECT_EQ(flow->data.size(), flow->step * flow->height);
}

TEST_F(InterfaceTest, PathDoesNotComeForEachPair) {
  constexpr double kRate_hz = 2.0;  // path_rate_hz
  const auto start = std::chrono::steady_clock::now();
  Received<nav_msgs::Path> paths("path");
  ASSERT_TRUE(waitUntil([&] {
    drive();
    return paths.last() != nullptr;
  }));
  for (int i = 0; i < 20; ++i) drive();
  const std::size_t count = paths.all().size();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  EXPECT_LE(count, 1.0 + kRate_hz * elapsed.count());
}

TEST_F(InterfaceTest, BadCameraInfoStopsItUntilAGoodOneComes) {
  const nav_msgs::Odometry before = drive();
  const std::uint64_t invalid_before = drops("camera_info_invalid");
  robot().publishInfos([](sensor_msgs::CameraInfo& info) { info.P[3] = 0.0; });
  ASSERT_TRUE(robot().statusWith(OdometryStatus::NO_CALIBRATION, "the baseline is zero"));
  const ros::Time stamp = robot().drive();
  EXPECT_FALSE(robot().odometryOf(stamp, milliseconds(300)));
  robot().publishInfos();
  recover();
  EXPECT_GT(drops("camera_info_invalid"), invalid_before);
  EXPECT_GE(drive().pose.pose.position.x, before.pose.pose.position.x);
}

TEST_F(InterfaceTest, PoseCanBeSet) {
  SetPose set_pose;
  EXPECT_TRUE(call("set_pose", set_pose));
  EXPECT_FALSE(set_pose.response.success) << "a quaternion of zeros";
  EXPECT_NE(set_pose.response.message.find("length 0"), std::string::npos);
  geometry_msgs::PoseWithCovarianceStamped& pose = set_pose.request.pose;
  pose.pose.pose.position.y = 30.0;
  pose.pose.pose.orientation.w = 1.0;
  pose.pose.covariance[0] = 4.0;
  pose.header.frame_id = "map";
  ASSERT_TRUE(call("set_pose", set_pose));
  EXPECT_FALSE(set_pose.response.success);
  EXPECT_NE(set_pose.response.message.find("must be in odom"), std::string::npos);
  pose.header.frame_id = "odom";
  ASSERT_TRUE(call("set_pose", set_pose));
  EXPECT_TRUE(set_pose.response.success) << set_pose.response.message;
  const nav_msgs::Odometry odometry = drive();
  EXPECT_NEAR(odometry.pose.pose.position.x, SimulatedRobot::kStep_m, 0.05);
  EXPECT_NEAR(odometry.pose.pose.position.y, 30.0, 0.05);
  EXPECT_NEAR(odometry.pose.covariance[0], 4.0, 0.1);
}

TEST_F(InterfaceTest, PauseDropsPairsAndKeepsThePose) {
  const nav_msgs::Odometry before = drive();
  std_srvs::SetBool pause;
  pause.request.data = true;
  ASSERT_TRUE(call("pause", pause));
  EXPECT_TRUE(robot().statusWith(OdometryStatus::PAUSED));
  const std::uint64_t paused_before = drops("paused");
  const ros::Time paused = robot().drive();
  EXPECT_TRUE(robot().statusThat(
      [&](const OdometryStatus& status) { return drops("paused", status) == paused_before + 1; }));
  EXPECT_FALSE(robot().odometryOf(paused, milliseconds(0)));
  pause.request.data = false;
  ASSERT_TRUE(call("pause", pause));
  const nav_msgs::Odometry after = drive();
  EXPECT_EQ(status_.state, OdometryStatus::INITIALIZING);
  EXPECT_EQ(after.pose.pose.position.x, before.pose.pose.position.x);
  recover();
}

/// Some pairs are dropped while it is paused.
TEST_F(InterfaceTest, ServicesMayBeCalledAllTheTime) {
  std::atomic<bool> done{false};
  std::thread caller([&] {
    const auto expectAnswer = [this](const std::string& name, auto service, bool success) {
      EXPECT_TRUE(call(name, service)) << name;
      EXPECT_EQ(service.response.success, success) << name << ": " << service.response.message;
    };
    for (int i = 0; i < 50; ++i) {
      expectAnswer("reset", std_srvs::Trigger(), true);
      std_srvs::SetBool pause;
      for (const bool paused : {true, false}) {
        pause.request.data = paused;
        expectAnswer("pause", pause, true);
      }
      SetPose pose;
      expectAnswer("set_pose", pose, false);  // its quaternion is zero
      pose.request.pose.pose.pose.orientation.w = 1.0;
      expectAnswer("set_pose", pose, true);
      expectAnswer("save_trajectory", SaveTrajectory(), false);  // without a path
      std::this_thread::sleep_for(milliseconds(10));
    }
    done = true;
  });
  while (!done) {
    robot().drive();
    std::this_thread::sleep_for(milliseconds(50));
  }
  caller.join();
  recover();
}

TEST_F(InterfaceTest, ParametersChangeLive) {
  dynamic_reconfigure::Reconfigure reconfigure;
  reconfigure.request.config.ints.resize(1);
  auto& parameter = reconfigure.request.config.ints[0];
  parameter.name = "feature_detector/max_features";
  parameter.value = 60;
  ASSERT_TRUE(call("set_parameters", reconfigure));
  drive();
  drive();
  EXPECT_LE(status_.with_depth, 60u);
  int stored = 0;
  EXPECT_TRUE(ros::param::get("/stereo_odometry/feature_detector/max_features", stored));
  EXPECT_EQ(stored, 60);
  EXPECT_EQ(drive_->log
                .with("parameters changed: feature_detector/max_features from 400 to 60",
                      ros::console::levels::Info)
                .size(),
            1u);
  parameter.value = -1;
  ASSERT_TRUE(call("set_parameters", reconfigure));
  EXPECT_EQ(reconfigure.response.config.ints[0].value, 60) << "rejected";
  parameter.value = 2000;
  ASSERT_TRUE(call("set_parameters", reconfigure));
  recover();
}

TEST_F(InterfaceTest, DiagnosticsHaveEachPart) {
  DiagnosticsListener diagnostics;
  // A fault of a previous test persists for some seconds.
  EXPECT_TRUE(waitUntil([&] {
    drive();
    const std::string input = diagnostics.text("stereo_odometry: input");
    return input.find("stereo pairs arrive") == 0 &&
           diagnostics.text("stereo_odometry: odometry") == "OK";
  }));
  for (const char* part : {"timing", "tf", "drops"}) {
    EXPECT_NE(diagnostics.text(std::string("stereo_odometry: ") + part), "") << part;
  }
}

}  // namespace
}  // namespace rotrocc
