// What the log, the status and the diagnostics tell of faults: each cause once.

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>

#include <diagnostic_msgs/DiagnosticArray.h>

#include "nodelet_drive.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr auto kInfo = ros::console::levels::Info;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class FaultsTest : public testing::Test {
 protected:
  FaultsTest() { drive_.setUp(); }

  using Change = std::function<void(sensor_msgs::Image& left, sensor_msgs::Image& right)>;

  OdometryStatus drive(const Change& change = {}) {
    auto [left, right] = drive_.robot.see();
    if (change) change(left, right);
    drive_.robot.publish(left, right);
    return drive_.statusOf(std::max(left.header.stamp, right.header.stamp));
  }

  /// Drives until the odometry is OK.
  void recover() {
    EXPECT_TRUE(waitUntil([&] { return drive().state == OdometryStatus::OK; }));
  }

  NodeletDrive drive_;
};

TEST_F(FaultsTest, AFrozenCameraMeasuresNothing) {
  recover();
  const nav_msgs::Odometry before = drive_.odometryOf(drive().header.stamp);
  std::optional<std::pair<sensor_msgs::Image, sensor_msgs::Image>> frozen;
  for (int i = 0; i < 5; ++i) {
    const OdometryStatus status = drive([&](sensor_msgs::Image& left, sensor_msgs::Image& right) {
      if (!frozen) frozen = {left, right};
      left.data = frozen->first.data;
      right.data = frozen->second.data;
    });
    if (i == 0) continue;
    EXPECT_EQ(status.state, OdometryStatus::LOST);
    EXPECT_TRUE(has(status.reason, "is the camera frozen")) << status.reason;
    const nav_msgs::Odometry odometry = drive_.odometryOf(status.header.stamp);
    EXPECT_EQ(odometry.twist.covariance[0], 9999.0);
    const double way_m = SimulatedRobot::kStep_m;  // at least, at the last speed
    EXPECT_GT(odometry.pose.covariance[0], before.pose.covariance[0] + 0.5 * way_m * way_m);
    EXPECT_NEAR(
        odometry.pose.pose.position.x - before.pose.pose.position.x, SimulatedRobot::kStep_m, 0.05);
  }
  const auto lines = [&] { return drive_.log.with("both images are those of the pair before"); };
  EXPECT_TRUE(waitUntil([&] { return drive().state == OdometryStatus::OK && !lines().empty(); }));
  EXPECT_EQ(lines().size(), 1u);
}

TEST_F(FaultsTest, EachCauseIsToldOnceAndSoIsItsEnd) {
  recover();
  const auto begin = std::chrono::steady_clock::now();
  OdometryStatus status;
  const auto untilHint = [&](const std::string& hint, const Change& change) {
    EXPECT_TRUE(waitUntil([&] {
      status = drive(change);
      return has(status.hint, hint);
    })) << hint;
    recover();
    const auto end = std::chrono::steady_clock::now() + LossLog::kRecovery;
    while (std::chrono::steady_clock::now() < end) EXPECT_EQ(drive().hint, "");
  };
  untilHint("its mean grey level is 0 of 255", [](auto& left, auto& right) {
    std::fill(left.data.begin(), left.data.end(), 0);
    std::fill(right.data.begin(), right.data.end(), 0);
  });
  untilHint("if left and right are swapped",
            [](auto& left, auto& right) { std::swap(left.data, right.data); });
  for (int i = 0; i < 20; ++i) {
    auto [left, right] = drive_.robot.see();
    left.header.stamp = ros::Time();
    drive_.robot.publish(left, right);
    status = drive();
  }
  ASSERT_EQ(status.drops.size(), 2u) << status.drops.back().reason;
  EXPECT_EQ(status.drops[0].reason, "stamp_zero");
  EXPECT_EQ(status.drops[1].reason, "partner_dropped");
  EXPECT_EQ(status.hint, "");

  const auto most = 1 + (std::chrono::steady_clock::now() - begin) / std::chrono::seconds(30);
  std::map<std::string, int> causes;
  std::size_t losses = 0;
  for (std::string text : drive_.log.with("")) {
    text.erase(std::remove_if(text.begin(), text.end(), ::isdigit), text.end());
    losses += has(text, ": lost: ") ? 1 : 0;
    if (has(text, ": lost")) text.erase(0, std::min(text.find("; "), text.size()));
    // Losses without a known cause, and what pairs say of the rig, are not of interest here.
    if (text.empty() || has(text, "recalibrate the stereo rig")) continue;
    EXPECT_LE(++causes[text], most) << text;
  }
  EXPECT_EQ(causes.size(), 3u) << "dark, swapped, no stamp";
  EXPECT_LE(drive_.log.with("recovered", kInfo).size(), losses);
}

TEST(DiagnosticsPeriodTest, IsThatOfTheStandardParameter) {
  ros::CallbackQueue queue;
  ros::NodeHandle nh;
  nh.setCallbackQueue(&queue);
  int published = 0;
  const boost::function<void(const diagnostic_msgs::DiagnosticArray::ConstPtr&)> count =
      [&](const auto& message) { published += message->status.size() > 1 ? 1 : 0; };
  const ros::Subscriber subscriber =
      nh.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 100, count);
  NodeletDrive drive({{"diagnostic_period", 1000.0}});
  int ticks = 0;
  ros::Time last;
  EXPECT_TRUE(waitUntil([&] {
    drive.robot.statusThat([&](const OdometryStatus& status) {
      ticks += std::exchange(last, status.header.stamp) != status.header.stamp ? 1 : 0;
      return true;
    });
    return ticks > 3;
  }));
  queue.callAvailable();
  EXPECT_LE(published, 1);
}

TEST(TrajectoryFaultTest, IsToldUntilTheFileIsWrittenAgain) {
  const TemporaryDirectory directory;
  const std::filesystem::path folder = directory / "drive";
  std::filesystem::create_directory(folder);
  DiagnosticsListener diagnostics;
  NodeletDrive drive({{"trajectory_file", (folder / "odom.txt").string()}});
  drive.setUp();
  std::filesystem::remove(folder);
  drive.odometryOf(drive.robot.drive());
  EXPECT_TRUE(diagnostics.says("stereo_odometry: trajectory file", "cannot write"));
  std::filesystem::create_directory(folder);
  drive.odometryOf(drive.robot.drive());
  EXPECT_TRUE(diagnostics.says("stereo_odometry: trajectory file", "written"));
  EXPECT_EQ(drive.log.with("trajectory file: ").size(), 1u);
}

}  // namespace
}  // namespace rotrocc
