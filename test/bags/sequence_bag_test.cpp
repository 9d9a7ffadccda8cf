// A sequence converted to a bag must be unchanged when it is read back.

#include <filesystem>
#include <stdexcept>

#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <tf2_eigen/tf2_eigen.h>

#include "bags/bag_reading.h"
#include "bags/recorded_tf.h"
#include "bags/sequence_bag_writer.h"
#include "input/camera_calibration.h"
#include "input/message_conversion.h"
#include "sequences/kitti_mount.h"
#include "support/asl_folder.h"
#include "support/expect_error.h"
#include "support/synthetic_scene.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr int kPairs = 4;

class SequenceBagTest : public ::testing::Test {
 protected:
  SequenceBagTest() {
    writeSyntheticSequence(directory_ / "sequence", kPairs);
    writeSequenceBag(bagPath(), directory_ / "sequence");
  }

  std::string bagPath() const { return directory_ / "sequence.bag"; }

  TemporaryDirectory directory_;
};

TEST_F(SequenceBagTest, FillsTheCameraInfo) {
  const Bags bag = openBags({bagPath()});
  const auto left = firstMessage<sensor_msgs::CameraInfo>(bag, "/stereo/left/camera_info");
  const auto right = firstMessage<sensor_msgs::CameraInfo>(bag, "/stereo/right/camera_info");
  ASSERT_TRUE(left && right);
  const StereoCamera camera = openStereoSequence(directory_ / "sequence", {}).calibration.rectified;
  EXPECT_EQ(left->header.frame_id, "stereo_left_optical");
  EXPECT_EQ(right->header.frame_id, "stereo_left_optical");
  EXPECT_EQ(left->P[3], 0.0);
  EXPECT_EQ(right->P[3], -camera.fx * camera.baseline_m);
  for (const auto& info : {left, right}) {
    EXPECT_EQ(info->K[0], camera.fx);
    EXPECT_EQ(info->K[4], camera.fy);
    EXPECT_EQ(info->K[8], 1.0);
    EXPECT_EQ(info->R[0] * info->R[4] * info->R[8], 1.0);
    EXPECT_EQ(info->D, std::vector<double>(5, 0.0));
    EXPECT_EQ(info->distortion_model, "plumb_bob");
  }
}

TEST_F(SequenceBagTest, HoldsTheTruePathOfTheBase) {
  const Bags bag = openBags({bagPath()});
  const auto path = firstMessage<nav_msgs::Path>(bag, "/ground_truth/path");
  const Trajectory truth = openStereoSequence(directory_ / "sequence", {}).ground_truth;
  ASSERT_TRUE(path);
  ASSERT_EQ(path->poses.size(), truth.size());
  Eigen::Isometry3d T_odom_base;
  tf2::fromMsg(path->poses.back().pose, T_odom_base);
  const Eigen::Isometry3d expected =
      kittiMount() * truth.back().T_world_body * kittiMount().inverse();
  EXPECT_TRUE(T_odom_base.isApprox(expected, 1e-8));
  EXPECT_GT(T_odom_base.translation().x(), 1.0) << "the car drives forward: along x";

  BagView poses(bag, {"/ground_truth/pose"});
  EXPECT_EQ(poses.size(), truth.size());
}

TEST_F(SequenceBagTest, PlaysInTheOrderItWasWritten) {
  const Bags bag = openBags({bagPath()});
  BagView view(bag);
  std::vector<std::string> topics;
  for (const rosbag::MessageInstance& message : view) topics.push_back(message.getTopic());
  ASSERT_GE(topics.size(), 7u);
  topics.resize(7);
  EXPECT_EQ(topics,
            (std::vector<std::string>{"/tf_static",
                                      "/ground_truth/path",
                                      "/ground_truth/pose",
                                      "/stereo/left/camera_info",
                                      "/stereo/left/image_rect",
                                      "/stereo/right/camera_info",
                                      "/stereo/right/image_rect"}));
}

TEST_F(SequenceBagTest, LeavesNothingUnfinished) {
  SequenceRecording recording(directory_ / "sequence", {});
  expectError<std::runtime_error>(
      [&] {
        writeSequenceBag(
            directory_ / "cut.bag", recording, [] { throw std::runtime_error("cut"); });
      },
      "cut");
  EXPECT_FALSE(std::filesystem::exists(directory_ / "cut.bag"));
  EXPECT_FALSE(std::filesystem::exists(directory_ / "cut.bag.part"));
}

TEST_F(SequenceBagTest, RejectsStampsThatRosHasNot) {
  directory_.write("sequence/times.txt", "5000000000\n5000000001\n5000000002\n5000000003\n");
  expectError<std::invalid_argument>([&] { SequenceRecording(directory_ / "sequence", {}); },
                                     "out of the range of ROS");
}

/// Of unrectified images.
class RawSequenceBagTest : public ::testing::Test {
 protected:
  std::string write(bool rectify = false) const {
    writeSequenceBag(directory_ / "raw.bag", folder_.path(), rectify);
    return directory_ / "raw.bag";
  }

  AslFolder folder_;
  TemporaryDirectory directory_;
};

TEST_F(RawSequenceBagTest, HoldsImagesAndCalibrationAsRecorded) {
  const Bags bag = openBags({write()});
  const StereoSequence sequence = openStereoSequence(folder_.path(), {});
  const auto image = firstMessage<sensor_msgs::Image>(bag, "/stereo/left/image_raw");
  ASSERT_TRUE(image);
  EXPECT_EQ(toNanoseconds(image->header.stamp), AslFolder::stamp_ns(0));
  EXPECT_EQ(image->data[0], 50);
  const auto left = firstMessage<sensor_msgs::CameraInfo>(bag, "/stereo/left/camera_info");
  const auto right = firstMessage<sensor_msgs::CameraInfo>(bag, "/stereo/right/camera_info");
  ASSERT_TRUE(left && right);
  const StereoCalibration calibration = toStereoCalibration(*left, *right);
  EXPECT_EQ(calibration.left.fx, 458.654);
  EXPECT_EQ(calibration.right.distortion.coefficients(),
            sequence.calibration.right.distortion.coefficients());
  EXPECT_EQ(calibration.right.R_rectified_raw, sequence.calibration.right.R_rectified_raw);
  EXPECT_DOUBLE_EQ(calibration.rectified.baseline_m, sequence.calibration.rectified.baseline_m);
  EXPECT_FALSE(calibration.isRectified());

  const RecordedTf tf = readTf(bag, "base_link", "stereo_left_optical");
  EXPECT_FALSE(tf.assumes_mount);
  EXPECT_EQ(tf.static_transforms.transforms.size(), 1u);
  EXPECT_TRUE(tf.trajectory.poses.empty());
  EXPECT_TRUE(tf.T_base_camera.isApprox(sequence.T_base_camera, 1e-9));
}

TEST_F(RawSequenceBagTest, HoldsRectifiedImagesOnRequest) {
  const Bags bag = openBags({write(true)});
  const auto left = firstMessage<sensor_msgs::CameraInfo>(bag, "/stereo/left/camera_info");
  const auto right = firstMessage<sensor_msgs::CameraInfo>(bag, "/stereo/right/camera_info");
  ASSERT_TRUE(left && right);
  EXPECT_TRUE(toStereoCalibration(*left, *right).isRectified());
  EXPECT_TRUE(firstMessage<sensor_msgs::Image>(bag, "/stereo/left/image_rect"));
  EXPECT_FALSE(firstMessage<sensor_msgs::Image>(bag, "/stereo/left/image_raw"));
}

TEST_F(RawSequenceBagTest, TruthMayBeginAfterTheFirstPair) {
  folder_.write("state_groundtruth_estimate0/data.csv",
                "#timestamp, ...\n" + std::to_string(AslFolder::stamp_ns(1)) + ",0,0,0,1,0,0,0\n" +
                    std::to_string(AslFolder::stamp_ns(2)) + ",1,0,0,1,0,0,0\n");
  const Bags bag = openBags({write()});
  const auto path = firstMessage<nav_msgs::Path>(bag, "/ground_truth/path");
  ASSERT_TRUE(path);
  EXPECT_EQ(path->poses.size(), 2u);
  BagView poses(bag, {"/ground_truth/pose"});
  EXPECT_EQ(poses.size(), 2u);
}

TEST_F(RawSequenceBagTest, HoldsTheGyroscopeInAxesOfTheBase) {
  folder_.write("imu0/data.csv",
                std::to_string(AslFolder::stamp_ns(0) - 5'000'000) + ",0.1,0.2,0.3,0,0,0\n" +
                    std::to_string(AslFolder::stamp_ns(9)) + ",0.1,0.2,0.3,0,0,0\n");
  const Bags bag = openBags({write()});
  const auto imu = firstMessage<sensor_msgs::Imu>(bag, "/imu/data");
  ASSERT_TRUE(imu);
  EXPECT_NEAR(imu->angular_velocity.y, 0.2, 1e-9) << "the base is the body, as the gyroscope";
  BagView samples(bag, {"/imu/data"});
  EXPECT_EQ(samples.size(), 2u) << "also after the last pair";
}

}  // namespace
}  // namespace rotrocc
