// What is told of the input and the rig: stamps of another time, and a bias once it lasts.

#include "nodelet_drive.h"

namespace rotrocc {
namespace {

TEST(WarningsTest, StampsOfAClockThatIsWrongAreTold) {
  const struct {
    double off_s;
    const char* said;
  } kCases[] = {{-100.0, "s behind the clock when the images arrive: synchronize the clocks"},
                {3.0, "s ahead of the clock, and so are odometry and tf"}};
  for (const auto& [off_s, said] : kCases) {
    SCOPED_TRACE(off_s);
    NodeletDrive drive;
    DiagnosticsListener diagnostics;
    drive.setUp();
    drive.robot.setTime(ros::Time::now() + ros::Duration(off_s));
    EXPECT_TRUE(waitUntil([&] {
      const OdometryStatus status = drive.statusOf(drive.robot.drive());
      EXPECT_LT(status.stamp_age_s * off_s, 0.0) << status.stamp_age_s;
      return status.hint.find(said) != std::string::npos;
    }));
    EXPECT_TRUE(diagnostics.says("stereo_odometry: input", said));
    EXPECT_TRUE(waitUntil([&] { return !drive.log.with(said).empty(); }));
  }
}

}  // namespace
}  // namespace rotrocc
