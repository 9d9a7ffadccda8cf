#include "bags/recorded_tf.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <tf2_eigen/tf2_eigen.h>

#include "bags/bag_reading.h"
#include "sequences/kitti_mount.h"
#include "sequences/stereo_sequence.h"
#include "support/kitti2bag_writer.h"
#include "support/synthetic_scene.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr int kPairs = 3;

class RecordedTfTest : public ::testing::Test {
 protected:
  RecordedTfTest() { writeSyntheticSequence(directory_ / "sequence", kPairs); }

  StereoSequence sequence() const { return openStereoSequence(directory_ / "sequence", {}); }

  /// Expects the camera's true poses, seen from the base that `T_base_camera` mounts it on.
  void expectTruth(const nav_msgs::Path& path, const Eigen::Isometry3d& T_base_camera) const {
    const Trajectory truth = sequence().ground_truth;
    EXPECT_EQ(path.header.frame_id, "odom");
    ASSERT_EQ(path.poses.size(), truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
      Eigen::Isometry3d T_odom_base;
      tf2::fromMsg(path.poses[i].pose, T_odom_base);
      const Eigen::Isometry3d expected =
          T_base_camera * truth[i].T_world_body * T_base_camera.inverse();
      // poses.txt has 10 digits; the world origin of the raw bag is 100 m away.
      EXPECT_TRUE(T_odom_base.isApprox(expected, 1e-6)) << "pose " << i;
    }
  }

  TemporaryDirectory directory_;
};

TEST_F(RecordedTfTest, TurnsPosesOfTheBaseIntoGroundTruth) {
  writeKitti2bagRaw(sequence(), directory_ / "raw.bag");
  const RecordedTf tf = readTf(openBags({directory_ / "raw.bag"}), "base_link", "camera_gray_left");
  EXPECT_FALSE(tf.assumes_mount);
  EXPECT_EQ(tf.static_transforms.transforms.size(), 2u) << "each mount once";
  EXPECT_EQ(tf.trajectory_name, "world -> base_link");
  const Eigen::Isometry3d T_base_camera = Eigen::Translation3d(-0.325, 0.0, 0.0) * kittiMount();
  expectTruth(tf.trajectory, T_base_camera);

  tf2_msgs::TFMessage message;
  message.transforms.resize(2);
  message.transforms[0].header.frame_id = "world";
  message.transforms[0].child_frame_id = "/base_link";
  message.transforms[1].header.frame_id = "base_link";
  message.transforms[1].child_frame_id = "wheel";
  const tf2_msgs::TFMessage kept = tf.transformsToPlay(message);
  ASSERT_EQ(kept.transforms.size(), 1u);
  EXPECT_EQ(kept.transforms.front().child_frame_id, "wheel");
}

TEST_F(RecordedTfTest, AddsTheMountWhereThereIsNone) {
  writeKitti2bagOdometry(sequence(), directory_ / "odometry.bag");
  const RecordedTf tf =
      readTf(openBags({directory_ / "odometry.bag"}), "base_link", "camera_gray_left");
  EXPECT_TRUE(tf.assumes_mount);
  ASSERT_EQ(tf.static_transforms.transforms.size(), 1u);
  const geometry_msgs::TransformStamped& mount = tf.static_transforms.transforms.front();
  EXPECT_EQ(mount.header.frame_id, "base_link");
  EXPECT_EQ(mount.child_frame_id, "camera_gray_left");
  EXPECT_TRUE(tf2::transformToEigen(mount).isApprox(kittiMount(), 1e-12));
  EXPECT_EQ(tf.trajectory_name, "world -> camera_left");
  expectTruth(tf.trajectory, kittiMount());
  EXPECT_NE(tf.note().find("KITTI's car"), std::string::npos) << tf.note();
}

TEST_F(RecordedTfTest, TheBaseOfAnotherCameraIsAtTheCamera) {
  writeKitti2bagOdometry(sequence(), directory_ / "odometry.bag");
  const RecordedTf tf =
      readTf(openBags({directory_ / "odometry.bag"}), "base_link", "left_optical");
  EXPECT_TRUE(tf.assumes_mount);
  EXPECT_TRUE(tf.T_base_camera.isApprox(mountAtCamera(), 1e-12));
  EXPECT_EQ(tf.note(),
            "no tf connects base_link and the left camera, left_optical: base_link is taken to be "
            "there, with x forward and z up");
}

}  // namespace
}  // namespace rotrocc
