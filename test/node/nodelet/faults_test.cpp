// What the diagnostics tell, and how often; test/stress has the faults of the input.

#include <filesystem>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <std_srvs/Trigger.h>

#include "nodelet_drive.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

TEST(DiagnosticsPeriodTest, IsThatOfTheStandardParameter) {
  Received<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
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
  int published = 0;
  for (const auto& message : diagnostics.all()) published += message->status.size() > 1 ? 1 : 0;
  EXPECT_LE(published, 1);
}

TEST(TrajectoryFaultTest, IsReportedUntilAnotherTrajectoryIsWritten) {
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
  std_srvs::Trigger reset;
  ASSERT_TRUE(drive.services.call("reset", reset));
  drive.odometryOf(drive.robot.drive());
  EXPECT_TRUE(diagnostics.says("stereo_odometry: trajectory file", "written"));
  EXPECT_EQ(drive.log.with("trajectory file: ").size(), 1u);
}

}  // namespace
}  // namespace rotrocc
