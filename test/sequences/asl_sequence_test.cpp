#include "sequences/stereo_sequence.h"

#include <fstream>
#include <stdexcept>

#include <gtest/gtest.h>

#include "support/asl_folder.h"
#include "support/expect_error.h"
#include "support/raw_rig.h"
#include "support/read_file.h"

namespace rotrocc {
namespace {

class AslSequenceTest : public ::testing::Test {
 protected:
  StereoSequence open() const { return openStereoSequence(folder_.path(), {}); }

  void expectRejected(const std::string& part) const {
    expectError<std::runtime_error>([this] { open(); }, part);
  }

  /// Replaces a part of a file.
  void change(const std::string& name, const std::string& from, const std::string& to) const {
    std::string text = readFile(folder_ / name);
    const std::size_t position = text.find(from);
    ASSERT_NE(position, std::string::npos) << name << " has no " << from;
    folder_.write(name, text.replace(position, from.size(), to));
  }

  AslFolder folder_;
};

TEST_F(AslSequenceTest, ReadsPairsAndCalibration) {
  StereoSequence sequence = open();
  ASSERT_EQ(sequence.size(), 3);
  EXPECT_EQ(sequence.stamp_ns(2), AslFolder::stamp_ns(2)) << "all digits";
  const StereoPair pair = sequence.read(1);
  EXPECT_EQ(pair.stamp_ns, AslFolder::stamp_ns(1));
  EXPECT_EQ(pair.left.at<uchar>(240, 300), 100);
  EXPECT_EQ(pair.right.size(), cv::Size(752, 480));
  EXPECT_EQ(sequence.pairs.leftOut(), "");
  EXPECT_EQ(rosTimeOffset_ns(sequence), 0);

  const RawRig rig = rawRig();
  const StereoCalibration expected = chooseRectification(rig.left, rig.right, rig.T_left_right);
  const StereoCalibration& calibration = sequence.calibration;
  EXPECT_FALSE(calibration.isRectified());
  // T_left_right of the rig is rounded to 1e-9.
  EXPECT_TRUE(calibration.left.R_rectified_raw.isApprox(expected.left.R_rectified_raw, 1e-7));
  EXPECT_NEAR(calibration.rectified.baseline_m, expected.rectified.baseline_m, 1e-8);
  EXPECT_NEAR(calibration.rectified.fx, expected.rectified.fx, 1e-3);
  EXPECT_EQ(calibration.right.distortion.coefficients()[1], 0.07451284);
}

TEST_F(AslSequenceTest, ReadsMav0ItselfFilesOfOpenCvAndEquidistantLenses) {
  EXPECT_EQ(openStereoSequence(folder_ / "", {}).size(), 3);
  folder_.write("cam0/sensor.yaml", "%YAML:1.0\n---\n" + readFile(folder_ / "cam0/sensor.yaml"));
  change("cam1/sensor.yaml", "T_BS:", "T_BS: !!opencv-matrix");
  for (const std::string camera : {"cam0", "cam1"}) {
    change(camera + "/sensor.yaml", "radial-tangential", "equidistant");
  }
  EXPECT_STREQ(open().calibration.left.distortion.name(), "equidistant");
}

TEST_F(AslSequenceTest, LeavesOutImagesWithoutAPartner) {
  std::filesystem::remove(folder_ /
                          ("cam1/data/" + std::to_string(AslFolder::stamp_ns(1)) + ".png"));
  EXPECT_EQ(open().pairs.leftOut(),
            "1 left image and 0 right images without a partner, 1 listed image without a file");
  EXPECT_EQ(open().size(), 2);
  change("cam0/data.csv", std::to_string(AslFolder::stamp_ns(0)), "1403636579763000000");
  EXPECT_EQ(open().size(), 2) << "0.6 ms apart";
  EXPECT_EQ(openStereoSequence(folder_.path(), {0.0001, 0.0}).size(), 1);
}

/// The body turns to the left and moves forward, with poses at 200 Hz that are not at the stamps of
/// the images; the last image is after the last pose.
TEST_F(AslSequenceTest, TruthIsThatOfTheRectifiedLeftCamera) {
  const auto poseAt = [](double t) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::AngleAxisd(0.3 * t, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    pose.translation() << 2.0 * t, -t, 0.5;
    return pose;
  };
  // The truth is of a sensor on the body.
  Eigen::Isometry3d T_body_sensor = Eigen::Isometry3d::Identity();
  T_body_sensor.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  T_body_sensor.translation() << 0.1, 0.2, 0.3;
  folder_.write(
      "state_groundtruth_estimate0/sensor.yaml",
      "T_BS:\n  cols: 4\n  rows: 4\n  data: [0, -1, 0, 0.1, 1, 0, 0, 0.2, 0, 0, 1, 0.3, 0, "
      "0, 0, 1]\n");
  std::ofstream truth(folder_ / "state_groundtruth_estimate0/data.csv");
  truth << "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
           "q_RS_z [], v_RS_R_x [m s^-1]\n"
        << std::setprecision(15);
  for (int i = -1; i < 15; ++i) {
    const double t = 0.005 * i + 0.0021;
    const Eigen::Isometry3d pose = poseAt(t) * T_body_sensor;
    const Eigen::Quaterniond q(pose.linear());
    truth << AslFolder::kStart_ns + std::llround(1e9 * t) << ',' << pose.translation().x() << ','
          << pose.translation().y() << ',' << pose.translation().z() << ',' << q.w() << ',' << q.x()
          << ',' << q.y() << ',' << q.z() << ",0\n";
  }
  truth.close();
  StereoSequence sequence = open();
  const Trajectory& poses = sequence.ground_truth;
  ASSERT_EQ(poses.size(), 2u) << "the last image is later than the truth";
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(poses[i].stamp_ns, AslFolder::stamp_ns(i));
    const Eigen::Isometry3d expected = poseAt(0.05 * i) * sequence.T_base_camera;
    // Between poses 5 ms apart, an arm of 0.4 m that turns by 0.3 rad/s is straight to 1e-7 m.
    EXPECT_TRUE(poses[i].T_world_body.isApprox(expected, 1e-6));
  }
  // What the left raw camera sees ahead is turned into the rectified frame.
  const Eigen::Vector3d ahead = sequence.T_base_camera.linear() *
                                sequence.calibration.left.R_rectified_raw *
                                Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(ahead.z(), 0.999660727178, 1e-9) << "the third column of T_BS";
}

TEST_F(AslSequenceTest, ReadsTheGyroscope) {
  EXPECT_TRUE(open().gyroscope("").samples.empty());
  expectError<std::runtime_error>([&] { open().gyroscope("imu0"); }, "has no gyroscope imu0");
  folder_.write("imu0/data.csv",
                "#timestamp [ns],w_RS_S_x [rad s^-1],...\n1403636579758555392,"
                "-0.099134701513277898,0.14730578886832138,0.02722713633111154,8.1\n");
  const GyroRecording gyro = open().gyroscope("");
  ASSERT_EQ(gyro.samples.size(), 1u);
  EXPECT_EQ(gyro.samples[0].stamp_ns, 1403636579758555392);
  // Without sensor.yaml its axes are those of the body.
  EXPECT_TRUE(gyro.R_camera_gyro.isApprox(open().T_base_camera.linear().transpose(), 1e-9));
}

TEST_F(AslSequenceTest, NamesWhatIsWrong) {
  const struct {
    const char *file, *text, *changed_text, *message;
  } rows[] = {
      {"cam0/sensor.yaml",
       "radial-tangential",
       "omni",
       "cam0/sensor.yaml: the distortion model 'omni' is not supported"},
      {"cam0/sensor.yaml",
       "camera_model: pinhole",
       "camera_model: omni",
       "camera_model is omni, but only pinhole is supported"},
      {"cam0/sensor.yaml",
       "0.0148655429818",
       "0.5",
       "T_BS is not rigid: its left 3x3 part is off orthonormality by 0."},
      {"cam0/sensor.yaml", "0.0, 0.0, 0.0, 1.0", "0.0, 0.0", "T_BS has 14 numbers instead of 16"},
      {"cam0/sensor.yaml", "458.654", ".nan", "intrinsics has a value that is not a finite number"},
      {"cam0/sensor.yaml", "intrinsics:", "intrinsic:", "cam0/sensor.yaml: intrinsics is missing"},
      {"cam1/sensor.yaml", "[752, 480]", "[640, 480]", "752x480 px, the right one 640x480 px"},
      {"cam1/sensor.yaml", "sensor_type:", "a: [b\n", "cam1/sensor.yaml is not YAML"},
      {"cam0/data.csv",
       "#timestamp [ns],filename\r\n",
       "1403636579763555584\n",
       "cam0/data.csv:1: 1 columns: timestamp [ns] and file name are expected"},
      {"cam0/data.csv",
       "#timestamp [ns],filename\r\n",
       "5,a.png\n5,b.png\n",
       "data.csv:2: the time 5 is not later than the previous one: sort the file by time"},
  };
  for (const auto& row : rows) {
    const std::string text = readFile(folder_ / row.file);
    change(row.file, row.text, row.changed_text);
    expectRejected(row.message);
    folder_.write(row.file, text);
  }
  folder_.write("cam1/sensor.yaml", readFile(folder_ / "cam0/sensor.yaml"));
  expectRejected("the baseline is zero");
  std::filesystem::remove_all(folder_ / "cam1/data");
  expectRejected("there is no pair: of 3 left images and 0 right images");
  std::filesystem::remove(folder_ / "cam1/data.csv");
  expectRejected("cannot read");
}

TEST_F(AslSequenceTest, NamesImagesThatCannotBeRead) {
  folder_.writeImage("cam1", AslFolder::stamp_ns(1), 9, {320, 240});
  folder_.write("cam0/data/" + std::to_string(AslFolder::stamp_ns(2)) + ".png", "no image");
  StereoSequence sequence = open();
  expectError<std::runtime_error>([&] { sequence.read(1); },
                                  "is 320 x 240 px, but the calibrated image is 752 x 480 px");
  expectError<std::runtime_error>([&] { sequence.read(2); }, "is not a readable image");
}

TEST(StereoSequenceTest, NamesTheLayoutsThatItKnows) {
  const TemporaryDirectory empty;
  expectError<std::runtime_error>([&] { openStereoSequence(empty / "", {}); },
                                  "nor mav0/cam0 (ASL, EuRoC)");
  expectError<std::runtime_error>([&] { openStereoSequence(empty / "none", {}); },
                                  "is not a directory");
}

}  // namespace
}  // namespace rotrocc
