#include "rotrocc/trajectory.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/read_file.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

const std::string kIdentity = "1 0 0 0 0 1 0 0 0 0 1 0\n";

StampedPose somePose(std::int64_t stamp_ns) {
  StampedPose pose;
  pose.stamp_ns = stamp_ns;
  pose.T_world_body.linear() =
      Eigen::AngleAxisd(2.8, Eigen::Vector3d(0.3, -0.8, 0.5).normalized()).toRotationMatrix();
  pose.T_world_body.translation() = Eigen::Vector3d(1.25, -1e-3, 1234.56789);
  return pose;
}

class TrajectoryTest : public ::testing::Test {
 protected:
  /// The file of these poses.
  std::string write(const std::vector<StampedPose>& poses, TrajectoryFormat format) const {
    TrajectoryWriter writer(directory_ / "out.txt", format);
    for (const StampedPose& pose : poses) writer.write(pose);
    return directory_ / "out.txt";
  }

  TemporaryDirectory directory_;
};

TEST_F(TrajectoryTest, FormatsHaveNames) {
  EXPECT_EQ(trajectoryFormat("kitti"), TrajectoryFormat::kKitti);
  EXPECT_EQ(trajectoryFormat("tum"), TrajectoryFormat::kTum);
  expectError<std::invalid_argument>([] { trajectoryFormat("KITTI"); }, "'KITTI'");
}

TEST_F(TrajectoryTest, DetectsTheFormatByTheFirstLineOfData) {
  EXPECT_EQ(detectTrajectoryFormat(directory_.write("a", "# x\n\n" + kIdentity)),
            TrajectoryFormat::kKitti);
  EXPECT_EQ(detectTrajectoryFormat(directory_.write("b", "0 0 0 0 0 0 0 1\n")),
            TrajectoryFormat::kTum);
  const std::string neither = directory_.write("c", "\n1 2 3\n");
  expectError<std::runtime_error>([&] { detectTrajectoryFormat(neither); }, "c:2: 3 numbers");
}

TEST_F(TrajectoryTest, WritesKittiLinesAsKittiDoes) {
  const std::string path = directory_ / "out.txt";
  TrajectoryWriter writer(path, TrajectoryFormat::kKitti);
  StampedPose pose;
  pose.T_world_body.translation().z() = 1.0 / 3.0;
  writer.write(pose);
  EXPECT_EQ(readFile(path),
            "1.000000000e+00 0.000000000e+00 0.000000000e+00 0.000000000e+00 "
            "0.000000000e+00 1.000000000e+00 0.000000000e+00 0.000000000e+00 "
            "0.000000000e+00 0.000000000e+00 1.000000000e+00 3.333333333e-01\n")
      << "a line must be on disk while the writer still lives";
}

TEST_F(TrajectoryTest, WritesTumStampsExactlyToTheNanosecond) {
  std::vector<StampedPose> poses(3);
  poses[0].stamp_ns = -1'500'000'000;
  poses[1].stamp_ns = 5;
  poses[2].stamp_ns = 1'317'000'000'123'456'789;
  const std::string path = write(poses, TrajectoryFormat::kTum);
  const std::string zeros =
      " 0.000000000 0.000000000 0.000000000 0.000000000 0.000000000 0.000000000";
  EXPECT_EQ(readFile(path),
            "-1.500000000" + zeros + " 1.000000000\n0.000000005" + zeros +
                " 1.000000000\n1317000000.123456789" + zeros + " 1.000000000\n");
}

TEST_F(TrajectoryTest, WritesQuaternionsWithPositiveW) {
  StampedPose pose;  // a rotation by 200 deg equals one by -160 deg: w must be cos(80 deg)
  pose.T_world_body.rotate(Eigen::AngleAxisd(200.0 * M_PI / 180.0, Eigen::Vector3d::UnitY()));
  const std::string line = readFile(write({pose}, TrajectoryFormat::kTum));
  EXPECT_NE(line.find(" -0.984807753 "), std::string::npos) << line;
  EXPECT_NE(line.find(" 0.173648178\n"), std::string::npos) << line;
}

TEST_F(TrajectoryTest, ReadsWhatItWrites) {
  const std::vector<StampedPose> poses = {somePose(1'317'000'000'123'456'789),
                                          somePose(1'317'000'000'223'456'788)};
  for (const auto format : {TrajectoryFormat::kKitti, TrajectoryFormat::kTum}) {
    const bool tum = format == TrajectoryFormat::kTum;
    const Trajectory read = readTrajectory(write(poses, format));
    ASSERT_EQ(read.size(), 2u);
    // KITTI keeps 10 digits of 1234.6 m, TUM 9 decimals.
    EXPECT_TRUE(read[0].T_world_body.isApprox(poses[0].T_world_body, 1e-9));
    EXPECT_EQ(read[0].stamp_ns, tum ? poses[0].stamp_ns : 0);
    EXPECT_EQ(read[1].stamp_ns, tum ? poses[1].stamp_ns : 100'000'000);
  }
}

TEST_F(TrajectoryTest, AcceptsCommentsBlankLinesCrlfAndAMissingLastNewline) {
  const std::string path = directory_.write(
      "tum.txt", "# stamp tx ty tz qx qy qz qw\r\n\r\n 1.5  1 2 3  0 0 0 1 \r\n2.5\t1 2 4 0 0 0 1");
  const Trajectory trajectory = readTrajectory(path);
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[0].stamp_ns, 1'500'000'000);
  EXPECT_EQ(trajectory[1].T_world_body.translation(), Eigen::Vector3d(1, 2, 4));
}

TEST_F(TrajectoryTest, RemovesTheRoundingOfPrintedRotations) {
  const std::string path =
      directory_.write("rounded.txt", "0.9396 0 0.3420 0 0 1 0 0 -0.3420 0 0.9396 0\n");
  const Eigen::Matrix3d rotation = readTrajectory(path).front().T_world_body.linear();
  EXPECT_TRUE((rotation * rotation.transpose()).isIdentity(1e-14));
  EXPECT_NEAR(std::atan2(rotation(0, 2), rotation(0, 0)), 20.0 * M_PI / 180.0, 1e-4);
}

TEST_F(TrajectoryTest, RejectsWhatIsNoTrajectory) {
  const std::pair<std::string, const char*> rows[] = {
      {"1.1 0 0 0 0 1 0 0 0 0 1 0\n", "bad.txt:1: the left 3x3 part is not a rotation"},
      {"-1 0 0 0 0 1 0 0 0 0 1 0\n", "a reflection"},
      {kIdentity + "nan 0 0 0 0 1 0 0 0 0 1 0\n", "bad.txt:2: 'nan'"},
      {"1 0 0 inf 0 1 0 0 0 0 1 0\n", "'inf'"},
      {"1 0 0 1e999 0 1 0 0 0 0 1 0\n", "1e999"},
      {"1 0 0 0x 0 1 0 0 0 0 1 0\n", "'0x' is not a finite number"},
      {"1 0 0 0,5 0 1 0 0 0 0 1 0\n", "the left 3x3 part is not a rotation"},
      {"0 0 0 0 0 0 0 0\n", "the quaternion has the length 0.0"},
      {"1e11 0 0 0 0 0 0 1\n", "'1e11' is not a time"},
      {"1.5 0 0 0 0 0 0 1\n1.5 0 0 0 0 0 0 1\n", "bad.txt:2: the time 1.5"},
      {"1 0 0 0 0 1 0 0 0 0 1\n", "11 numbers"},
      {kIdentity + "1 0 0 0 0 1 0 0 0 0 1 0 garbage\n", "bad.txt:2: 13 numbers"},
      {kIdentity + "0 0 0 0 0 0 0 1\n", "bad.txt:2: 8 numbers, but 12"},
      {"", "no data"},
      {"# only a comment\n\n", "no data"}};
  for (const auto& [text, message] : rows) {
    const std::string path = directory_.write("bad.txt", text);
    expectError<std::runtime_error>([&] { readTrajectory(path); }, message);
  }
  expectError<std::runtime_error>([&] { readTrajectory(directory_ / "none.txt"); }, "none.txt");
  // A directory opens like a file on Linux, but has no lines.
  expectError<std::runtime_error>([&] { readTrajectory(directory_ / ""); }, "cannot read");
  const std::string times = directory_.write("times.txt", "0.1\n0.0\n");
  expectError<std::runtime_error>([&] { readTimes(times); }, "times.txt:2: the time 0.0");
}

TEST_F(TrajectoryTest, ReadsWhatPeopleHave) {
  const std::string bom = "\xEF\xBB\xBF";
  const struct {
    std::string text;
    std::int64_t stamp_ns;
  } rows[] = {
      // A quarter turn about z, at 1 2 3 m.
      {"0 -1 0 1 1 0 0 2 0 0 1 3\n", 0},
      {"0 -1 0 1 1 0 0 2 0 0 1 3 0 0 0 1\n", 0},
      {"1.5 0 -1 0 1 1 0 0 2 0 0 1 3\n", 1'500'000'000},
      {"1.5 1 2 3 0 0 0.70710678 0.70710678\n", 1'500'000'000},
      {bom + "timestamp,tx,ty,tz,qx,qy,qz,qw\n1.5,1,2,3,0,0,0.70710678,0.70710678\n",
       1'500'000'000},
      {"1403636579763 1 2 3 0 0 0.70710678 0.70710678\n", 1403636579763'000'000},
      {"#timestamp [ns],p_RS_R_x [m],...\n1403636579763555584,1,2,3,0.70710678,0,0,0.70710678\n",
       1403636579763555584},
      {"1403636579763555584,1,2,3,0.70710678,0,0,0.70710678,1,2,3,4,5,6,7,8,9\r\n",
       1403636579763555584}};
  for (const auto& [text, stamp_ns] : rows) {
    SCOPED_TRACE(text);
    const Trajectory poses = readTrajectory(directory_.write("poses.txt", text));
    ASSERT_EQ(poses.size(), 1u);
    EXPECT_EQ(poses[0].stamp_ns, stamp_ns);
    EXPECT_TRUE(poses[0].T_world_body.translation().isApprox(Eigen::Vector3d(1, 2, 3)));
    EXPECT_NEAR(poses[0].T_world_body.linear()(1, 0), 1.0, 1e-6);
  }
}

/// Turns by 1 rad/s and moves by 2 m/s, with a pose every 10 ms from 0 to 90 ms.
Trajectory turn() {
  Trajectory poses;
  for (int i = 0; i < 10; ++i) {
    const double t = 0.01 * i;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::AngleAxisd(t, Eigen::Vector3d::UnitY()).toRotationMatrix();
    pose.translation() << 0.0, 0.0, 2.0 * t;
    poses.push_back({i * 10'000'000, pose});
  }
  return poses;
}

TEST(TrajectorySamplingTest, InterpolatesPoses) {
  const auto pose = poseAt(turn(), 33'000'000, 10'000'000);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->translation().z(), 0.066, 1e-12);
  EXPECT_NEAR(Eigen::AngleAxisd(pose->linear()).angle(), 0.033, 1e-12);
  EXPECT_EQ(poseAt(turn(), 30'000'000, 0)->matrix(), turn()[3].T_world_body.matrix())
      << "to the last digit, at a stamp";
}

TEST(TrajectorySamplingTest, HasNoPosesOutsideAndInGaps) {
  EXPECT_FALSE(poseAt(turn(), -1, 10'000'000));
  EXPECT_FALSE(poseAt(turn(), 90'000'001, 10'000'000));
  EXPECT_FALSE(poseAt(turn(), 33'000'000, 9'999'999));
  EXPECT_FALSE(poseAt({}, 0, 10'000'000));
  EXPECT_EQ(samplePoses(turn(), {-5, 5, 95'000'000}).size(), 1u);
}

TEST_F(TrajectoryTest, WriterSaysWhenItCannotWrite) {
  expectError<std::runtime_error>(
      [&] { TrajectoryWriter(directory_ / "none/out.txt", TrajectoryFormat::kTum); },
      "none/out.txt");
  TrajectoryWriter full("/dev/full", TrajectoryFormat::kTum);
  expectError<std::runtime_error>([&] { full.write({}); }, "/dev/full");
}

}  // namespace
}  // namespace rotrocc
