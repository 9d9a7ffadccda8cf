// The rows of docs/bad_inputs.md that need a ROS master: the nodelet runs in this process, so that
// each message has arrived as soon as it is published. The other rows are in bad_inputs_test.

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>
#include <tf2_ros/transform_broadcaster.h>

#include "input/to_text.h"
#include "node/health/odometry_health.h"
#include "node/stereo_odometry_nodelet.h"
#include "rotrocc/SaveTrajectory.h"
#include "rotrocc/SetPose.h"
#include "support/bad_input_table.h"
#include "support/log_recorder.h"
#include "support/service_caller.h"
#include "support/simulated_robot.h"

namespace rotrocc {
namespace {

using std::chrono::milliseconds;

const char* const kName = "/stereo_odometry";
constexpr double kSpeed_mps = SimulatedRobot::kStep_m / SimulatedRobot::kPeriod_s;
constexpr double kSpeedTolerance_mps = 0.05 * kSpeed_mps;

/// Waits for a condition, at most half a minute: longer than under any load.
bool comesTrue(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (std::chrono::steady_clock::now() < deadline) {
    if (condition()) return true;
    std::this_thread::sleep_for(milliseconds(20));
  }
  return false;
}

/// The parameters of the nodelet that is loaded next.
class NodeletParameters {
 public:
  NodeletParameters() { ros::param::del(kName); }

  template <class Value>
  NodeletParameters& set(const std::string& name, const Value& value) {
    ros::param::set(std::string(kName) + "/" + name, value);
    return *this;
  }
};

/// The nodelet and its robot.
class Drive {
 public:
  explicit Drive(const NodeletParameters& = {}) {
    nodelet_.init(kName, {}, {}, &queue_, &queue_);
    spinner_.start();
    robot_.emplace();
  }

  SimulatedRobot& robot() { return *robot_; }
  const LogRecorder& log() const { return log_; }

  /// Publishes a pair, and waits until the callbacks of the nodelet are done with it.
  void publish(const sensor_msgs::Image& left, const sensor_msgs::Image& right) {
    robot_->publish(left, right);
    EXPECT_TRUE(comesTrue([this] { return queue_.isEmpty(); }));
  }

  /// camera_info and the mount of the camera.
  void setUp() {
    robot_->publishInfos();
    robot_->publishMount();
  }

  /// The state of the next pair of the drive, after a change.
  std::string drive(const std::function<void(sensor_msgs::Image&)>& change = {}) {
    return stateOfPair(robot_->drive(change));
  }

  /// The state of a pair that was published; if OK, also whether the speed is wrong.
  std::string stateOfPair(const ros::Time& stamp, double true_speed_mps = kSpeed_mps) {
    const auto status = robot_->statusOf(stamp);
    const auto odometry = robot_->odometryOf(stamp);
    if (!status || !odometry) return "no odometry";
    status_ = *status;
    const double error_mps = odometry->twist.twist.linear.x - true_speed_mps;
    const bool wrong =
        status->state == OdometryStatus::OK && std::abs(error_mps) > kSpeedTolerance_mps;
    return stateName(status->state) + std::string(wrong ? ", but the speed is wrong" : "");
  }

  /// The state of the last of some valid pairs.
  std::string recovery() {
    std::string state;
    for (int i = 0; i < 4; ++i) state = drive();
    return "; then " + state;
  }

  /// Drives on without odometry until the status has `state` and a reason that starts with
  /// `reason`.
  std::string waitForStatus(std::uint8_t state, const std::string& reason) {
    OdometryStatus last;
    const bool came = comesTrue([&] {
      robot_->drive();
      const auto status = robot_->statusWith(state, "", milliseconds(100));
      if (status) last = *status;
      return status && status->reason.find(reason) == 0;
    });
    return stateName(last.state) + std::string(came ? ": " : " for another reason: ") + last.reason;
  }

  std::uint64_t drops(const std::string& reason) const {
    for (const DropCount& drop : status_.drops) {
      if (drop.reason == reason) return drop.count;
    }
    return 0;
  }

  /// Of the last pair that drive() or stateOfPair() has waited for.
  const OdometryStatus& status() const { return status_; }

 private:
  LogRecorder log_;
  ros::CallbackQueue queue_;
  StereoOdometryNodelet nodelet_;
  ros::AsyncSpinner spinner_{1, &queue_};
  std::optional<SimulatedRobot> robot_;
  OdometryStatus status_;
};

std::string noClock() {
  std::string observed;
  {
    Drive drive(NodeletParameters().set("silence_s", 0.5));
    const auto status = drive.robot().statusWith(OdometryStatus::NO_INPUT);
    observed = status ? std::string(stateName(status->state)) + ": " + status->reason : "no status";
    const bool warned =
        comesTrue([&] { return !drive.log().with("there is no message on /clock").empty(); });
    observed += warned ? "; logged as a warning" : "; no warning";
  }
  return observed + "; shuts down when requested";
}

std::string noCameraInfo() {
  Drive drive(NodeletParameters().set("silence_s", 0.5));
  std::string observed =
      drive.waitForStatus(OdometryStatus::NO_CALIBRATION, "/left/camera_info has a publisher");
  const bool warned = comesTrue(
      [&] { return !drive.log().with("Likely: /left/camera_info has a publisher").empty(); });
  observed += warned ? "; logged as a warning" : "; no warning";
  drive.setUp();
  return observed + drive.recovery();
}

void leaveOutFrame(sensor_msgs::Image& image) {
  image.header.frame_id.clear();
}

std::string emptyFrame() {
  std::string observed;
  {
    Drive drive;
    drive.setUp();
    for (int i = 0; i < 3; ++i) drive.drive();
    const ros::Time stamp = drive.robot().drive(leaveOutFrame);
    const std::string dropped = "dropped (frame_id_missing, 1 so far): ";
    EXPECT_TRUE(comesTrue([&] { return !drive.log().with(dropped).empty(); }));
    const std::string line = drive.log().with(dropped).front();
    observed = line.substr(line.find(dropped)) + drive.recovery();
    EXPECT_FALSE(drive.robot().odometryOf(stamp, milliseconds(0)));
  }
  Drive drive(NodeletParameters().set("camera_frame", "camera_left"));
  drive.setUp();
  std::string state;
  for (int i = 0; i < 3; ++i) state = drive.drive(leaveOutFrame);
  return observed + "; with camera_frame " + state;
}

/// tf knows the frame of the left images only.
std::string otherFrame() {
  Drive drive;
  drive.setUp();
  std::string state;
  for (int i = 0; i < 3; ++i) {
    auto [left, right] = drive.robot().see();
    right.header.frame_id = "other";
    drive.publish(left, right);
    state = drive.stateOfPair(left.header.stamp);
  }
  return state;
}

/// Pairs of a robot at rest that arrive at once, while each waits for the tf of its wheels, which
/// comes with every tenth pair.
std::string burst() {
  constexpr int kPairs = 101;
  Drive drive(NodeletParameters().set("guess_frame", "wheel_odom").set("guess_timeout_s", 1.0));
  tf2_ros::TransformBroadcaster wheels;
  geometry_msgs::TransformStamped at_rest;
  at_rest.header.frame_id = "wheel_odom";
  at_rest.child_frame_id = "base_link";
  at_rest.transform.rotation.w = 1.0;
  drive.setUp();
  for (int i = 0; i < 3; ++i) drive.drive();
  const std::uint64_t processed_before = drive.status().pairs_processed;
  auto [left, right] = drive.robot().see();
  for (int i = 0; i < kPairs; ++i) {
    left.header.stamp += ros::Duration(0.01);
    right.header.stamp = left.header.stamp;
    drive.publish(left, right);
    at_rest.header.stamp = left.header.stamp;
    if (i % 10 == 0) wheels.sendTransform(at_rest);
  }
  const std::string state = drive.stateOfPair(left.header.stamp, 0.0);
  const std::uint64_t processed = drive.status().pairs_processed - processed_before;
  const std::uint64_t dropped = drive.drops("newer_pair_came");
  return "the last one is " + state + "; processed and dropped (newer_pair_came) are " +
         toText(processed + dropped) + (dropped > kPairs / 2 ? ", most of them dropped" : "");
}

geometry_msgs::TransformStamped makeTransform(const std::string& child) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "base_link";
  transform.child_frame_id = child;
  transform.transform.rotation.w = 1.0;
  return transform;
}

/// A bad mount, and in the same message another frame, which shows that it was received.
std::string badMount(const std::function<void(geometry_msgs::Transform&)>& spoil) {
  tf2_msgs::TFMessage message;
  message.transforms = {makeTransform("camera_left"), makeTransform("beside_it")};
  spoil(message.transforms.front().transform);
  ros::Publisher publisher =
      ros::NodeHandle().advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
  publisher.publish(message);
  Drive drive;
  drive.robot().publishInfos();
  const std::string reason =
      "no tf from base_link to camera_left (camera pose): \"camera_left\" passed";
  const std::string observed = drive.waitForStatus(OdometryStatus::NO_TF, reason);
  drive.setUp();
  // The rest is the message of tf2.
  return observed.substr(0, observed.find(" (camera pose)")) + drive.recovery();
}

/// Calls all services repeatedly in its own thread until end().
class RepeatedCalls {
 public:
  ~RepeatedCalls() { end(); }

  /// Returns how many calls had a wrong response.
  int end() {
    done_ = true;
    if (thread_.joinable()) thread_.join();
    return wrong_answers_;
  }

  int rounds() const { return rounds_; }

 private:
  template <class Service>
  void call(const std::string& name, Service service, bool success) {
    if (!services_.call(name, service) || service.response.success != success) ++wrong_answers_;
  }

  void work() {
    while (!done_) {
      call("reset", std_srvs::Trigger(), true);
      std_srvs::SetBool pause;
      pause.request.data = true;
      call("pause", pause, true);
      pause.request.data = false;
      call("pause", pause, true);
      SetPose pose;
      call("set_pose", pose, false);  // its quaternion is zero
      pose.request.pose.pose.pose.orientation.w = 1.0;
      call("set_pose", pose, true);
      call("save_trajectory", SaveTrajectory(), false);  // without a path
      ++rounds_;
      std::this_thread::sleep_for(milliseconds(10));
    }
  }

  std::atomic<bool> done_{false};
  std::atomic<int> rounds_{0};
  std::atomic<int> wrong_answers_{0};
  ServiceCaller services_{kName};
  std::thread thread_{&RepeatedCalls::work, this};
};

std::string save(const std::string& path) {
  SaveTrajectory save;
  save.request.path = path;
  save.request.format = "tum";
  if (!ros::service::call(std::string(kName) + "/save_trajectory", save)) return "no response";
  return std::string(save.response.success ? "success: " : "failure: ") + save.response.message;
}

std::string services() {
  Drive drive;
  std::string observed = "before the first pair " + save("/no/such/directory/poses.txt");
  RepeatedCalls caller;
  EXPECT_TRUE(comesTrue([&] { return caller.rounds() > 5; }));
  drive.setUp();
  const int before = caller.rounds();
  // No waiting for odometry: some pairs are dropped while it is paused.
  for (int i = 0; i < 40 || caller.rounds() < before + 20; ++i) drive.robot().drive();
  observed += "; " + toText(caller.end()) + " wrong responses while pairs arrive";
  observed += drive.recovery();
  return observed + "; " + save("/no/such/directory/poses.txt") + "; " + save("");
}

std::vector<BadInput> rowsWithoutClock() {
  return {
      {50,
       "use_sim_time without /clock",
       "a warning, no hang at shutdown",
       noClock,
       "NO_INPUT: use_sim_time is true, but there is no message on /clock: *; logged as a warning; "
       "shuts down when requested"},
  };
}

std::vector<BadInput> rowsWithClock() {
  return {
      {26,
       "no camera_info",
       "a warning names the topic",
       noCameraInfo,
       "NO_CALIBRATION: /left/camera_info has a publisher, but no messages arrive: *; logged as a "
       "warning; then OK"},
      {40,
       "frame_id empty",
       "dropped, or camera_frame is used",
       emptyFrame,
       "dropped (frame_id_missing, 1 so far): the left image has an empty frame_id: set it in the "
       "driver, or set the parameter camera_frame; then OK; with camera_frame OK"},
      {41,
       "frame_id of left and right differ",
       "accepted, the frame of the left image is used",
       otherFrame,
       "OK"},
      {49,
       "burst of 101 pairs, each of which takes long",
       "the newest is processed, drops are counted",
       burst,
       "the last one is OK; processed and dropped (newer_pair_came) are 101, most of them dropped"},
      {51,
       "tf with NaN or a quaternion not of unit length",
       "rejected; waits for a valid one",
       [] {
         const double nan = std::numeric_limits<double>::quiet_NaN();
         return "NaN: " + badMount([&](auto& mount) { mount.translation.x = nan; }) +
                "; length 0.5: " + badMount([](auto& mount) { mount.rotation.w = 0.5; });
       },
       "NaN: NO_TF: no tf from base_link to camera_left; then OK; length 0.5: NO_TF: no tf from "
       "base_link to camera_left; then OK"},
      {52,
       "service calls at any time and from another thread, bad path",
       "report failure, no deadlock",
       services,
       "before the first pair failure: there are no poses: no pair has been processed; 0 wrong "
       "responses while pairs arrive; then OK; failure: cannot write "
       "/no/such/directory/poses.txt*; failure: the path is empty: give an output file"},
  };
}

TEST(BadInputsNodeletTest, EachIsHandledAsTheTableSays) {
  ros::AsyncSpinner spinner(2);
  spinner.start();
  ros::NodeHandle nh;
  ros::Publisher clock = nh.advertise<rosgraph_msgs::Clock>("/clock", 1);
  std::vector<BadInput> inputs = rowsWithoutClock();
  std::vector<BadInput> with_clock = rowsWithClock();
  // The clock stays at a time shortly after the stamps of the images.
  with_clock.front().observe = [&, observe = with_clock.front().observe] {
    rosgraph_msgs::Clock time;
    time.clock = ros::Time(1100.0);
    EXPECT_TRUE(comesTrue([&] {
      clock.publish(time);
      return !ros::Time::now().isZero();
    }));
    return observe();
  };
  inputs.insert(inputs.end(), with_clock.begin(), with_clock.end());
  expectRows(Observer::kNodelet, inputs);
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "bad_inputs_nodelet_test");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
