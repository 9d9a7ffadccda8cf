// The interface of the odometry, as a node or a nodelet: one for all tests, reset before each.

#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <gtest/gtest.h>
#include <nav_msgs/Path.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>
#include <Eigen/Eigenvalues>

#include "input/message_conversion.h"
#include "rotrocc/SaveTrajectory.h"
#include "rotrocc/SetPose.h"
#include "rotrocc/rigid_motion.h"
#include "rotrocc/trajectory.h"
#include "support/run_command.h"
#include "support/service_caller.h"
#include "support/simulated_robot.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

using std::chrono::milliseconds;

class StereoOdometryTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    spinner_ = std::make_unique<ros::AsyncSpinner>(2);
    spinner_->start();
    robot_ = std::make_unique<SimulatedRobot>();
    services_ = std::make_unique<ServiceCaller>("stereo_odometry");
  }

  static void TearDownTestSuite() {
    services_.reset();
    robot_.reset();
    spinner_.reset();
  }

  /// Drives the first two pairs, whatever state the previous test has left.
  void SetUp() override {
    robot_->publishInfos();
    robot_->publishMount();
    std_srvs::SetBool resume;
    std_srvs::Trigger reset;
    ASSERT_TRUE(call("pause", resume));
    ASSERT_TRUE(call("reset", reset));
    first_ = drive();
    ASSERT_EQ(status_.state, OdometryStatus::INITIALISING);
    recover();
  }

  template <class Service>
  static bool call(const std::string& name, Service& service) {
    return services_->call(name, service);
  }

  /// Drives a step and returns its odometry; its status is then in status_.
  static nav_msgs::Odometry drive() {
    const ros::Time stamp = robot_->drive();
    const auto odometry = robot_->odometryOf(stamp);
    const auto status = robot_->statusOf(stamp);
    EXPECT_TRUE(odometry) << "no odometry for " << stamp;
    EXPECT_TRUE(status) << "no status for " << stamp;
    if (!odometry || !status) return {};
    status_ = *status;
    return *odometry;
  }

  /// Drives on until the odometry is OK again.
  static void recover() {
    for (int i = 0; i < 5; ++i) {
      drive();
      if (status_.state == OdometryStatus::OK) return;
    }
    FAIL() << "state " << static_cast<int>(status_.state) << ": " << status_.reason;
  }

  static std::uint64_t drops(const std::string& reason, const OdometryStatus& status = status_) {
    for (const DropCount& drop : status.drops) {
      if (drop.reason == reason) return drop.count;
    }
    return 0;
  }

  /// Drives until a pair with that change is dropped for that reason: a newer pair may replace it
  /// before it is checked.
  static void expectDrop(const std::string& reason,
                         const std::function<void(sensor_msgs::Image&)>& change) {
    const std::uint64_t before = drops(reason);
    ros::Time stamp;
    EXPECT_TRUE(waitUntil([&] {
      stamp = robot_->drive(change);
      drive();
      return drops(reason) > before;
    })) << reason;
    EXPECT_FALSE(robot_->odometryOf(stamp, milliseconds(0))) << reason;
  }

  static std::unique_ptr<ros::AsyncSpinner> spinner_;
  static std::unique_ptr<SimulatedRobot> robot_;
  static std::unique_ptr<ServiceCaller> services_;
  static OdometryStatus status_;
  nav_msgs::Odometry first_;
};

std::unique_ptr<ros::AsyncSpinner> StereoOdometryTest::spinner_;
std::unique_ptr<SimulatedRobot> StereoOdometryTest::robot_;
std::unique_ptr<ServiceCaller> StereoOdometryTest::services_;
OdometryStatus StereoOdometryTest::status_;

using Array36 = nav_msgs::Odometry::_pose_type::_covariance_type;

double smallestEigenvalue(const Array36& covariance) {
  const Matrix6d matrix = Eigen::Map<const Matrix6d>(covariance.data());
  return Eigen::SelfAdjointEigenSolver<Matrix6d>(matrix).eigenvalues().minCoeff();
}

/// The first message on a topic while the robot drives.
template <class Message, class Drive>
boost::shared_ptr<const Message> receiveWhile(const std::string& topic, Drive drive) {
  boost::shared_ptr<const Message> received;
  std::mutex mutex;
  ros::NodeHandle nh;
  const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
      [&](const boost::shared_ptr<const Message>& message) {
        const std::lock_guard<std::mutex> lock(mutex);
        received = message;
      };
  const ros::Subscriber subscriber = nh.subscribe<Message>(topic, 1, callback);
  waitUntil([&] {
    drive();
    const std::lock_guard<std::mutex> lock(mutex);
    return received != nullptr;
  });
  const std::lock_guard<std::mutex> lock(mutex);
  return received;
}

TEST_F(StereoOdometryTest, DrivesForwardInAxesOfTheBase) {
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

TEST_F(StereoOdometryTest, StatusTellsThePartsOfTheLatency) {
  const auto begin = std::chrono::steady_clock::now();
  drive();
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - begin;
  const std::vector<float> parts = {status_.time_waiting,
                                    status_.time_conversion,
                                    status_.time_total,
                                    status_.time_publishing,
                                    status_.time_rest};
  for (std::size_t i = 0; i < parts.size(); ++i) EXPECT_GT(parts[i], 0.0f) << i;
  const float rounding = 1e-5f * status_.latency;
  EXPECT_NEAR(std::accumulate(parts.begin(), parts.end(), 0.0f), status_.latency, rounding);
  EXPECT_LE(status_.time_pyramids + status_.time_corners + status_.time_disparity +
                status_.time_tracking + status_.time_estimation,
            status_.time_total + status_.time_prepared + rounding);
  EXPECT_GE(status_.time_pairing, 0.0f);
  EXPECT_LT(status_.time_pairing + status_.latency, elapsed.count());
}

TEST_F(StereoOdometryTest, FindsCornersBeforeThePairArrives) {
  ASSERT_TRUE(waitUntil([&] {  // once the rows of the rig are known, if the keyframe is replaced
    drive();
    return status_.time_prepared > 0.0f;
  }));
  EXPECT_LE(status_.time_corners + status_.time_disparity, status_.time_prepared);
}

TEST_F(StereoOdometryTest, TfIsThePoseOfTheOdometry) {
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

TEST_F(StereoOdometryTest, PicturesComeForSubscribers) {
  const auto path = receiveWhile<nav_msgs::Path>("path", drive);
  ASSERT_TRUE(path);
  EXPECT_EQ(path->header.frame_id, "odom");
  EXPECT_EQ(path->poses.front().header.stamp, first_.header.stamp);
  EXPECT_GT(path->poses.size(), 2u);

  const auto inliers = receiveWhile<sensor_msgs::PointCloud2>("inliers", drive);
  ASSERT_TRUE(inliers);
  EXPECT_EQ(inliers->header.frame_id, "camera_left");
  EXPECT_GT(inliers->width, 50u);

  const auto flow = receiveWhile<sensor_msgs::Image>("flow", drive);
  ASSERT_TRUE(flow);
  EXPECT_EQ(flow->encoding, "bgr8");
  EXPECT_EQ(flow->data.size(), flow->step * flow->height);
}

TEST_F(StereoOdometryTest, PathDoesNotComeForEachPair) {
  constexpr double kRate_hz = 2.0;  // path_rate_hz
  std::atomic<int> paths{0};
  ros::NodeHandle nh;
  const boost::function<void(const nav_msgs::Path::ConstPtr&)> callback =
      [&](const nav_msgs::Path::ConstPtr&) { ++paths; };
  const auto start = std::chrono::steady_clock::now();
  const ros::Subscriber subscriber = nh.subscribe<nav_msgs::Path>("path", 100, callback);
  ASSERT_TRUE(waitUntil([&] {
    drive();
    return paths > 0;
  }));
  for (int i = 0; i < 20; ++i) drive();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  EXPECT_LE(paths, 1.0 + kRate_hz * elapsed.count());
}

TEST_F(StereoOdometryTest, LosesItselfInTheDarkAndRecovers) {
  const nav_msgs::Odometry before = drive();
  const std::uint64_t lost_before = status_.pairs_lost;
  ros::Time dark;
  for (int i = 0; i < 3; ++i) {
    dark =
        robot_->drive([](sensor_msgs::Image& image) { image.data.assign(image.data.size(), 0); });
    ASSERT_TRUE(robot_->odometryOf(dark)) << "odometry comes for lost pairs, too";
  }
  const auto lost = robot_->odometryOf(dark);
  const auto status = robot_->statusOf(dark);
  ASSERT_TRUE(status);
  EXPECT_EQ(status->state, OdometryStatus::LOST);
  EXPECT_FALSE(status->reason.empty());
  EXPECT_EQ(status->pairs_lost, lost_before + 3);
  EXPECT_EQ(lost->pose.pose.position.x, before.pose.pose.position.x);
  EXPECT_GT(lost->pose.covariance[0], before.pose.covariance[0] + 1.0);
  EXPECT_EQ(lost->twist.twist.linear.x, 0.0);
  EXPECT_EQ(lost->twist.covariance[0], 9999.0);
  recover();
  EXPECT_GT(drive().pose.pose.position.x,
            before.pose.pose.position.x + 0.5 * SimulatedRobot::kStep_m);
}

TEST_F(StereoOdometryTest, MalformedImagesAreRejected) {
  expectDrop("image_encoding", [](sensor_msgs::Image& image) { image.encoding = "32FC1"; });
  expectDrop("image_data", [](sensor_msgs::Image& image) { image.data.resize(100); });
  expectDrop("image_not_of_camera_info", [](sensor_msgs::Image& image) { image.height -= 10; });
  recover();
}

TEST_F(StereoOdometryTest, BadCameraInfoStopsItUntilAGoodOneComes) {
  const nav_msgs::Odometry before = drive();
  const std::uint64_t invalid_before = drops("camera_info_invalid");
  robot_->publishInfos([](sensor_msgs::CameraInfo& info) { info.P[3] = 0.0; });
  ASSERT_TRUE(robot_->statusWith(OdometryStatus::NO_CALIBRATION, "the baseline is zero"));
  const ros::Time stamp = robot_->drive();
  EXPECT_FALSE(robot_->odometryOf(stamp, milliseconds(300)));
  robot_->publishInfos();
  recover();
  EXPECT_GT(drops("camera_info_invalid"), invalid_before);
  EXPECT_GE(drive().pose.pose.position.x, before.pose.pose.position.x);
}

TEST_F(StereoOdometryTest, ContinuesWhenTimeJumpsBack) {
  const nav_msgs::Odometry before = drive();
  robot_->turnBackTime();
  const nav_msgs::Odometry after = drive();
  EXPECT_EQ(status_.state, OdometryStatus::INITIALISING);
  EXPECT_LT(after.header.stamp, before.header.stamp);
  EXPECT_EQ(after.pose.pose.position.x, before.pose.pose.position.x);
  recover();
}

TEST_F(StereoOdometryTest, ResetBeginsAtZero) {
  EXPECT_GT(drive().pose.pose.position.x, SimulatedRobot::kStep_m);
  std_srvs::Trigger reset;
  ASSERT_TRUE(call("reset", reset));
  EXPECT_TRUE(reset.response.success) << reset.response.message;
  EXPECT_EQ(drive().pose.pose.position.x, 0.0);
  EXPECT_EQ(status_.state, OdometryStatus::INITIALISING);
  recover();
}

TEST_F(StereoOdometryTest, PoseCanBeSet) {
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

TEST_F(StereoOdometryTest, PauseDropsPairsAndKeepsThePose) {
  const nav_msgs::Odometry before = drive();
  std_srvs::SetBool pause;
  pause.request.data = true;
  ASSERT_TRUE(call("pause", pause));
  EXPECT_TRUE(robot_->statusWith(OdometryStatus::PAUSED));
  const std::uint64_t paused_before = drops("paused");
  const ros::Time paused = robot_->drive();
  EXPECT_TRUE(robot_->statusThat(
      [&](const OdometryStatus& status) { return drops("paused", status) == paused_before + 1; }));
  EXPECT_FALSE(robot_->odometryOf(paused, milliseconds(0)));
  pause.request.data = false;
  ASSERT_TRUE(call("pause", pause));
  const nav_msgs::Odometry after = drive();
  EXPECT_EQ(status_.state, OdometryStatus::INITIALISING);
  EXPECT_EQ(after.pose.pose.position.x, before.pose.pose.position.x);
  recover();
}

TEST_F(StereoOdometryTest, TrajectoryIsSaved) {
  const TemporaryDirectory directory;
  SaveTrajectory save;
  save.request.path = directory / "poses.txt";
  save.request.format = "tum";
  const ros::Time stamp = drive().header.stamp;
  ASSERT_TRUE(call("save_trajectory", save));
  EXPECT_TRUE(save.response.success) << save.response.message;
  const Trajectory poses = readTrajectory(save.request.path);
  EXPECT_EQ(toRosTime(poses.back().stamp_ns), stamp);
  save.request.path = "/no/such/directory/poses.txt";
  ASSERT_TRUE(call("save_trajectory", save));
  EXPECT_FALSE(save.response.success);
  EXPECT_NE(save.response.message.find("cannot write /no/such"), std::string::npos);
}

TEST_F(StereoOdometryTest, ServicesMayBeCalledAllTheTime) {
  std::atomic<bool> done{false};
  std::thread caller([&] {
    for (int i = 0; i < 100; ++i) {
      std_srvs::Trigger reset;
      std_srvs::SetBool pause;
      pause.request.data = i % 2 == 0;
      SaveTrajectory save;
      EXPECT_TRUE(call("reset", reset));
      EXPECT_TRUE(call("pause", pause));
      EXPECT_TRUE(call("save_trajectory", save));
      std::this_thread::sleep_for(milliseconds(10));
    }
    done = true;
  });
  while (!done) {
    robot_->drive();
    std::this_thread::sleep_for(milliseconds(50));
  }
  caller.join();
  recover();
}

TEST_F(StereoOdometryTest, ParametersChangeLive) {
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
  EXPECT_TRUE(ros::param::get("stereo_odometry/feature_detector/max_features", stored));
  EXPECT_EQ(stored, 60);
  parameter.value = -1;
  ASSERT_TRUE(call("set_parameters", reconfigure));
  EXPECT_EQ(reconfigure.response.config.ints[0].value, 60) << "refused";
  parameter.value = 2000;
  ASSERT_TRUE(call("set_parameters", reconfigure));
  recover();
}

TEST_F(StereoOdometryTest, DiagnosticsTellAnotherParentOfTheBase) {
  std::mutex mutex;
  std::map<std::string, diagnostic_msgs::DiagnosticStatus> last;
  ros::NodeHandle nh;
  const boost::function<void(const diagnostic_msgs::DiagnosticArray&)> callback =
      [&](const diagnostic_msgs::DiagnosticArray& message) {
        const std::lock_guard<std::mutex> lock(mutex);
        for (const auto& status : message.status) last[status.name] = status;
      };
  const ros::Subscriber subscriber =
      nh.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10, callback);
  tf2_ros::TransformBroadcaster broadcaster;
  geometry_msgs::TransformStamped wheels;
  wheels.header.frame_id = "wheel_odom";
  wheels.child_frame_id = "base_link";
  wheels.transform.rotation.w = 1.0;
  const auto level = [&](const std::string& part) {
    return last["stereo_odometry: " + part].level;
  };
  const auto text = [&](const std::string& part) {
    return last["stereo_odometry: " + part].message;
  };
  // A fault of a previous test persists for some seconds.
  EXPECT_TRUE(waitUntil(
      [&] {
        drive();
        broadcaster.sendTransform(wheels);
        const std::lock_guard<std::mutex> lock(mutex);
        return level("tf") > 0 && text("input") == "stereo pairs arrive" &&
               text("odometry") == "OK";
      },
      milliseconds(100)));
  const std::lock_guard<std::mutex> lock(mutex);
  EXPECT_NE(text("tf").find("publishes tf wheel_odom -> base_link"), std::string::npos)
      << text("tf");
  for (const char* part : {"timing", "drops"}) {
    EXPECT_EQ(last.count(std::string("stereo_odometry: ") + part), 1u) << part;
  }
}

TEST_F(StereoOdometryTest, SilenceIsExplained) {
  std::mutex mutex;
  std::set<std::string> said;  // log messages up to their first number
  ros::NodeHandle nh;
  const boost::function<void(const rosgraph_msgs::Log::ConstPtr&)> callback =
      [&](const rosgraph_msgs::Log::ConstPtr& log) {
        const std::lock_guard<std::mutex> lock(mutex);
        said.insert(log->msg.substr(0, log->msg.find_first_of("0123456789")));
      };
  const ros::Subscriber subscriber = nh.subscribe<rosgraph_msgs::Log>("/rosout", 100, callback);
  const auto isSaid = [&](const std::string& words) {
    const std::lock_guard<std::mutex> lock(mutex);
    return said.count(words) > 0;
  };

  // The test itself is the publisher; without one the reason would differ.
  EXPECT_TRUE(robot_->statusWith(OdometryStatus::NO_INPUT, "left/image_rect has a publisher"));
  EXPECT_TRUE(waitUntil([&] { return isSaid("/stereo_odometry: no stereo pair for "); }));
  recover();
  EXPECT_TRUE(
      waitUntil([&] { return isSaid("/stereo_odometry: stereo pairs arrive again, after "); }));
}

TEST_F(StereoOdometryTest, AnUnknownParameterIsRefused) {
  std::string command;
  ASSERT_TRUE(ros::param::get("~start_another", command));
  const int status = runCommand(command + " __name:=another _max_gap:=1.0").status;
  EXPECT_TRUE(status == 1 || status == 255) << "status " << status << " of a node, of nodelet load";
  recover();
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "stereo_odometry_test");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
