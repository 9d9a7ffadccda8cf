// What is told of the input and the rig: stamps of another time, and a bias once it lasts.

#include "nodelet_drive.h"

namespace rotrocc {
namespace {

TEST(WarningsTest, StampsOfAClockThatIsWrongAreTold) {
  const struct {
    double off_s;
    const char* said;
  } kCases[] = {{-100.0, "s behind the clock when the images arrive: synchronise the clocks"},
                {3.0, "s ahead of the clock, and so are odometry and tf"}};
  for (const auto& [off_s, said] : kCases) {
    SCOPED_TRACE(off_s);
    NodeletDrive drive;
    DiagnosticsListener diagnostics;
    drive.setUp();
    drive.robot.setTime(ros::Time::now() + ros::Duration(off_s));
    EXPECT_TRUE(waitUntil([&] {
      const OdometryStatus status = drive.statusOf(drive.robot.drive());
      EXPECT_LT(status.stamp_age * off_s, 0.0) << status.stamp_age;
      return status.hint.find(said) != std::string::npos;
    }));
    EXPECT_TRUE(diagnostics.says("stereo_odometry: input", said));
    EXPECT_TRUE(waitUntil([&] { return !drive.log.with(said).empty(); }));
  }
}

/// The right camera is calibrated wrongly for some pairs, then for good.
TEST(WarningsTest, ABiasIsToldOnceItLasts) {
  const std::string said = "disparities have a bias of";
  NodeletDrive drive;
  drive.setUp();
  const auto isBiased = [&] {
    return drive.statusOf(drive.robot.drive()).disparity_bias_applied > 0.5f;
  };
  const auto calibrateWrongly = [&] {
    drive.robot.publishInfos([](sensor_msgs::CameraInfo& info) {
      if (info.P[3] != 0.0) info.P[2] -= 1.5;
    });
  };
  calibrateWrongly();
  EXPECT_TRUE(waitUntil(isBiased));
  isBiased();
  drive.robot.publishInfos();
  for (int pair = 0; pair < RigWatch::kPairs; ++pair) isBiased();
  EXPECT_EQ(drive.log.with(said).size(), 0u);
  calibrateWrongly();
  EXPECT_TRUE(waitUntil([&] {
    isBiased();
    return !drive.log.with(said).empty();
  }));
  EXPECT_EQ(drive.log.with(said).size(), 1u);
}

}  // namespace
}  // namespace rotrocc
