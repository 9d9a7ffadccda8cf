#include "node/tf/sensor_pose.h"

#include <chrono>
#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include "sequences/kitti_mount.h"
#include "support/expect_error.h"
#include "support/log_recorder.h"
#include "support/tf_messages.h"

namespace rotrocc {
namespace {

TEST(DescribeCameraPoseTest, SaysPlaceViewAndImage) {
  EXPECT_EQ(describeCameraPose(kittiMount()),
            "at 0 0 1.65 m, looks along +x (forward), its image is upright");
  Eigen::Isometry3d tilted = kittiMount();
  tilted.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  tilted.rotate(Eigen::AngleAxisd(M_PI / 9.0, Eigen::Vector3d::UnitY()));
  EXPECT_EQ(
      describeCameraPose(tilted),
      "at 0 0 1.65 m, looks along +x (forward), 20 deg to the left, its image is not upright, "
      "the camera rolled by 180 deg");
  for (const double down : {-1.0, 1.0}) {
    Eigen::Isometry3d mast = kittiMount();
    mast.rotate(Eigen::AngleAxisd(-down * M_PI / 9.0, Eigen::Vector3d::UnitX()));
    mast.rotate(Eigen::AngleAxisd(M_PI / 36.0, Eigen::Vector3d::UnitZ()));
    EXPECT_EQ(describeCameraPose(mast),
              std::string("at 0 0 1.65 m, looks along +x (forward), 20 deg ") +
                  (down > 0.0 ? "down" : "up") +
                  ", its image is upright, the camera rolled by 5 deg clockwise");
  }
  EXPECT_EQ(describeCameraPose(Eigen::Isometry3d::Identity()),
            "at 0 0 0 m, looks along +z (up); is its frame an optical frame, with z forward?");
  Eigen::Isometry3d down(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  down.translation().z() = 12.0;
  EXPECT_EQ(describeCameraPose(down), "at 0 0 12 m, looks along -z (down)");
}

constexpr std::int64_t kSecond = 1'000'000'000;

/// A head that has turned to the left.
Eigen::Isometry3d panned(double left_rad) {
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
  T_base_camera.translation().z() = 1.0;
  T_base_camera.rotate(Eigen::AngleAxisd(left_rad, Eigen::Vector3d::UnitZ()));
  return T_base_camera;
}

double panOf(const std::optional<Eigen::Isometry3d>& T_base_camera) {
  if (!T_base_camera) return NAN;
  return std::atan2(T_base_camera->linear()(1, 0), T_base_camera->linear()(0, 0));
}

class SensorPoseTest : public testing::Test {
 protected:
  /// The camera turns on a torso that does not move.
  SensorPoseTest() { sendTf("base_link", "torso", 0.0, Eigen::Isometry3d::Identity(), tf_); }

  /// Stamp 0: for good.
  void sendPan(double stamp_s, double left_rad) {
    sendTf("torso", "camera", stamp_s, panned(left_rad), tf_);
  }

  /// The angle of the camera, if it is known.
  double panAt(double stamp_s) {
    return panOf(camera_.find("camera", std::llround(1e9 * stamp_s), wait_));
  }

  tf2::BufferCore tf_;
  LogRecorder log_;
  SensorPose camera_{tf_, "base_link", 0.2};
  /// What comes while a pair waits.
  std::function<void()> meanwhile_ = [] {};
  int waits_ = 0;
  WaitFor wait_ = [this](double limit_s, const std::function<bool()>& condition) {
    EXPECT_EQ(limit_s, 0.2);
    ++waits_;
    meanwhile_();
    return condition();
  };
};

TEST_F(SensorPoseTest, AFixedPoseIsKeptUntilItIsRefreshed) {
  EXPECT_TRUE(std::isnan(panAt(5.0)));
  EXPECT_EQ(camera_.missing().find("no tf from base_link to camera"), 0u) << camera_.missing();
  sendPan(0.0, 0.2);
  EXPECT_NEAR(panAt(6.0), 0.2, 1e-12);
  EXPECT_EQ(camera_.missing(), "");
  EXPECT_EQ(camera_.problem(), "");
  sendPan(0.0, 0.3);
  EXPECT_NEAR(panAt(7.0), 0.2, 1e-12);
  EXPECT_EQ(
      camera_.problem().find("another static tf of the camera camera arrived, which is not used"),
      0u)
      << camera_.problem();
  camera_.refresh();
  EXPECT_EQ(camera_.problem(), "");
  EXPECT_NEAR(panAt(8.0), 0.3, 1e-12);
  EXPECT_EQ(waits_, 0);
}

TEST_F(SensorPoseTest, WaitsForAValidTransform) {
  Eigen::Isometry3d unknown = panned(0.2);
  unknown.translation().x() = NAN;
  sendTf("torso", "camera", 0.0, panned(0.2), tf_, 2.0);
  EXPECT_TRUE(std::isnan(panAt(5.0)));
  sendTf("torso", "camera", 0.0, unknown, tf_);
  EXPECT_TRUE(std::isnan(panAt(5.0)));
  sendPan(0.0, 0.2);
  EXPECT_NEAR(panAt(6.0), 0.2, 1e-12);
}

TEST_F(SensorPoseTest, TheBaseItselfNeedsNoTf) {
  EXPECT_TRUE(camera_.find("base_link", kSecond, wait_)->isApprox(Eigen::Isometry3d::Identity()));
}

TEST_F(SensorPoseTest, APoseThatMovesIsThatAtTheStamp) {
  sendPan(100.0, 0.0);
  sendPan(101.0, 0.5);
  sendPan(102.0, 0.7);
  EXPECT_NEAR(panAt(100.0), 0.0, 1e-9);
  EXPECT_NEAR(panAt(100.5), 0.25, 1e-9);
  EXPECT_NEAR(panAt(101.5), 0.6, 1e-9);
  meanwhile_ = [this] { sendPan(103.0, 0.8); };
  EXPECT_NEAR(panAt(103.0), 0.8, 1e-9) << "it is late";
  EXPECT_EQ(waits_, 1);
}

TEST_F(SensorPoseTest, AtRestSlowTfIsWaitedForOnce) {
  sendPan(100.0, 0.3);
  for (int i = 0; i < 100; ++i) {
    if (i == 50) sendPan(101.0, 0.3 + 1e-6);  // noise of a joint
    EXPECT_NEAR(panAt(101.0 + i), 0.3, 1e-5);
  }
  EXPECT_EQ(waits_, 1);
  sendPan(102.0, 0.4);
  EXPECT_TRUE(std::isnan(panAt(300.0))) << "it moves";
  EXPECT_EQ(waits_, 2);
}

TEST_F(SensorPoseTest, OfOneThatMovesLateTfIsAProblemWithItsRateAndARemedy) {
  for (int i = 0; i <= 10; ++i) sendPan(100.0 + 0.3 * i, 0.1 * i);
  EXPECT_NEAR(panAt(100.0), 0.0, 1e-9);
  EXPECT_NEAR(panAt(103.0), 1.0, 1e-9);
  EXPECT_EQ(camera_.problem(), "");
  EXPECT_TRUE(std::isnan(panAt(103.1)));
  EXPECT_EQ(camera_.missing(), "");
  EXPECT_EQ(
      camera_.problem(),
      "tf from base_link to camera, which moves, arrives at 3.3 Hz and more than "
      "transform_timeout_s = 0.2 s after the images: publish it at the rate of the images, or "
      "raise transform_timeout_s to 0.33");
  EXPECT_TRUE(std::isnan(panAt(90.0))) << "tf was not there yet";
  EXPECT_NE(camera_.missing(), "");
  for (int i = 1; i <= 50; ++i) {
    EXPECT_NE(camera_.problem(), "");
    sendPan(110.0 + 0.1 * i, 0.0);
    panAt(110.0 + 0.1 * i);
  }
  EXPECT_EQ(camera_.problem(), "");
  for (int i = 1; i <= 100; ++i) sendPan(120.0 + 0.1 * i, 0.0);
  EXPECT_EQ(panAt(130.0), 0.0);
  std::this_thread::sleep_for(std::chrono::seconds(1));  // the rate is read once a second
  EXPECT_TRUE(std::isnan(panAt(130.1)));
  EXPECT_EQ(camera_.problem(),
            "tf from base_link to camera, which moves, arrives at 10.0 Hz and more than "
            "transform_timeout_s = 0.2 s after the images: publish it earlier, or raise "
            "transform_timeout_s");
  EXPECT_EQ(log_.with("which moves, arrives").size(), 1u) << "a lasting fault is logged rarely";
}

/// Each transform comes in time, but while a pair waits for it, newer ones replace each other.
TEST_F(SensorPoseTest, WaitsThatAreLongerThanThePeriodOfTheImagesAreAProblem) {
  for (int i = 0; i <= 10; ++i) sendPan(100.0 + 0.06 * i, 0.1 * i);
  panAt(100.58);
  panAt(100.60);
  meanwhile_ = [this] {
    std::this_thread::sleep_for(std::chrono::milliseconds(40));
    sendPan(100.66, 1.1);
  };
  EXPECT_NEAR(panAt(100.62), 1.1 - 0.2 / 3.0, 1e-9);
  EXPECT_EQ(camera_.problem(),
            "tf from base_link to camera, which moves, arrives at 16.7 Hz and later than the next "
            "images, so pairs are dropped: publish it at the rate of the images");
  EXPECT_EQ(log_.with("so pairs are dropped").size(), 1u);
}

/// As at a start, when images come before tf.
TEST_F(SensorPoseTest, ATransformAfterTheImagesIsNotWaitedFor) {
  sendPan(100.0, 0.3);
  EXPECT_NEAR(panAt(99.0), 0.3, 1e-9);
  EXPECT_EQ(waits_, 0);
}

TEST_F(SensorPoseTest, AnotherFrameIsAnotherPoseAndIsLogged) {
  sendPan(0.0, 0.2);
  sendTf("torso", "rear_camera", 0.0, panned(M_PI / 2.0), tf_);
  EXPECT_NEAR(panAt(5.0), 0.2, 1e-12);
  EXPECT_NEAR(panOf(camera_.find("rear_camera", 6 * kSecond, wait_)), M_PI / 2.0, 1e-12);
  EXPECT_NEAR(panAt(7.0), 0.2, 1e-12);
  EXPECT_EQ(log_.with("changed from camera to rear_camera").size(), 1u);
}

geometry_msgs::Transform makeTransform(double x, double qw, double qz) {
  geometry_msgs::Transform transform;
  transform.translation.x = x;
  transform.rotation.w = qw;
  transform.rotation.z = qz;
  return transform;
}

TEST(ToEigenTest, TakesWhatIsATransform) {
  const Eigen::Isometry3d T = toEigen(makeTransform(2.0, std::sqrt(0.5), std::sqrt(0.5)));
  EXPECT_TRUE((T * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(2, 1, 0)));
  // As rounded in a launch file.
  EXPECT_NEAR(toEigen(makeTransform(0.0, 0.707, 0.707)).linear().determinant(), 1.0, 1e-12);
}

TEST(ToEigenTest, RejectsWhatIsNone) {
  expectError([] { toEigen(makeTransform(NAN, 1.0, 0.0)); }, "the transform contains nan");
  expectError([] { toEigen(makeTransform(0.0, INFINITY, 0.0)); }, "the transform contains inf");
  expectError([] { toEigen(makeTransform(0.0, 0.0, 0.0)); }, "has the length 0, but must have 1");
  expectError([] { toEigen(makeTransform(0.0, 1.0, 1.0)); }, "has the length 1.41421");
}

}  // namespace
}  // namespace rotrocc
