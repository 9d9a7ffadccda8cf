#include "node/tf/sensor_mount.h"

#include <cmath>
#include <future>
#include <thread>

#include <gtest/gtest.h>

#include "sequences/kitti_mount.h"
#include "support/expect_error.h"
#include "support/log_recorder.h"
#include "support/tf_recording.h"

namespace rotrocc {
namespace {

TEST(DescribeMountTest, SaysPlaceViewAndImage) {
  EXPECT_EQ(describeMount(kittiMount()),
            "at 0 0 1.65 m, looks along +x (forward), its image is upright");
  Eigen::Isometry3d tilted = kittiMount();
  tilted.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  tilted.rotate(Eigen::AngleAxisd(M_PI / 9.0, Eigen::Vector3d::UnitY()));
  EXPECT_EQ(describeMount(tilted),
            "at 0 0 1.65 m, looks along +x (forward), 20 deg off, its image is not upright");
  EXPECT_EQ(describeMount(Eigen::Isometry3d::Identity()),
            "at 0 0 0 m, looks along +z (up); is its frame an optical frame, with z forward?");
  Eigen::Isometry3d down(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  down.translation().z() = 12.0;
  EXPECT_EQ(describeMount(down), "at 0 0 12 m, looks along -z (down)");
}

constexpr std::int64_t kSecond = 1'000'000'000;

/// A head that has turned to the left.
Eigen::Isometry3d panned(double left_rad) {
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
  T_base_camera.translation().z() = 1.0;
  T_base_camera.rotate(Eigen::AngleAxisd(left_rad, Eigen::Vector3d::UnitZ()));
  return T_base_camera;
}

double panOf(const std::optional<UncertainTransform>& T_base_camera) {
  if (!T_base_camera) return NAN;
  return std::atan2(T_base_camera->T.linear()(1, 0), T_base_camera->T.linear()(0, 0));
}

class SensorMountTest : public testing::Test {
 protected:
  void sendPan(double stamp_s, double left_rad) {
    tf_.send("torso", "camera", stamp_s, panned(left_rad));
  }

  /// Its chain has a part that does not move.
  void SetUp() override { tf_.sendStatic("base_link", "torso", Eigen::Isometry3d::Identity()); }

  TfRecording tf_;
  LogRecorder log_;
};

TEST_F(SensorMountTest, AFixedMountIsLookedUpOnceAndTfIsLeft) {
  SensorMount mount("base_link", 0.0, tf_.feed());
  EXPECT_FALSE(mount.find("camera", 5 * kSecond));
  EXPECT_NE(mount.missing(), "");
  tf_.sendStatic("torso", "camera", panned(0.2));
  EXPECT_NEAR(panOf(mount.find("camera", 6 * kSecond)), 0.2, 1e-12);
  EXPECT_EQ(mount.missing(), "");
  EXPECT_FALSE(tf_.hasListener());
  EXPECT_NEAR(panOf(mount.find("camera", 7 * kSecond)), 0.2, 1e-12);
  EXPECT_EQ(tf_.listenersStarted(), 1);
}

TEST_F(SensorMountTest, ANewFixedMountIsFoundWhenItLooksAgain) {
  tf_.sendStatic("torso", "camera", panned(0.2));
  SensorMount mount("base_link", 0.0, tf_.feed());
  EXPECT_NEAR(panOf(mount.find("camera", 5 * kSecond)), 0.2, 1e-12);
  tf_.sendStatic("torso", "camera", panned(0.3));
  EXPECT_NEAR(panOf(mount.find("camera", 6 * kSecond)), 0.2, 1e-12);
  mount.lookAgain();
  EXPECT_NEAR(panOf(mount.find("camera", 7 * kSecond)), 0.3, 1e-12);
  EXPECT_FALSE(tf_.hasListener());
}

TEST_F(SensorMountTest, WaitsForAValidTransform) {
  SensorMount mount("base_link", 0.0, tf_.feed());
  Eigen::Isometry3d unknown = panned(0.2);
  unknown.translation().x() = NAN;
  for (const double length : {2.0, 1.0}) {
    tf_.sendStatic("torso", "camera", length == 1.0 ? unknown : panned(0.2), length);
    EXPECT_FALSE(mount.find("camera", 5 * kSecond));
    EXPECT_EQ(mount.missing().find("no tf from base_link to camera"), 0u) << mount.missing();
  }
  tf_.sendStatic("torso", "camera", panned(0.2));
  EXPECT_NEAR(panOf(mount.find("camera", 6 * kSecond)), 0.2, 1e-12);
}

TEST_F(SensorMountTest, TheBaseItselfNeedsNoTf) {
  SensorMount mount("camera", 0.0, tf_.feed());
  EXPECT_TRUE(mount.find("camera", 5 * kSecond)->T.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_FALSE(tf_.hasListener());
}

TEST_F(SensorMountTest, AMovingMountIsThatAtTheStamp) {
  SensorMount mount("base_link", 0.0, tf_.feed());
  sendPan(100.0, 0.0);
  sendPan(101.0, 0.5);
  sendPan(102.0, 0.7);
  EXPECT_NEAR(panOf(mount.find("camera", 100 * kSecond)), 0.0, 1e-9);
  EXPECT_NEAR(panOf(mount.find("camera", 100 * kSecond + kSecond / 2)), 0.25, 1e-9);
  EXPECT_NEAR(panOf(mount.find("camera", 101 * kSecond + kSecond / 2)), 0.6, 1e-9);
  EXPECT_TRUE(tf_.hasListener());
}

TEST_F(SensorMountTest, ALateTransformIsWaitedForWithABound) {
  SensorMount mount("base_link", 1000.0, tf_.feed());
  sendPan(100.0, 0.0);
  EXPECT_TRUE(mount.find("camera", 100 * kSecond));
  sendPan(101.0, 0.5);
  std::thread late([&] { sendPan(102.0, 0.7); });
  EXPECT_NEAR(panOf(mount.find("camera", 102 * kSecond)), 0.7, 1e-9);
  late.join();
  SensorMount impatient("base_link", 0.01, tf_.feed());
  sendPan(100.0, 0.0);
  sendPan(101.0, 0.5);
  EXPECT_TRUE(impatient.find("camera", 100 * kSecond));
  EXPECT_FALSE(impatient.find("camera", 102 * kSecond));
  EXPECT_NE(impatient.missing().find("raise mount_timeout_s = 0.01"), std::string::npos)
      << impatient.missing();
}

/// With waiting at each stamp, this takes an hour.
TEST_F(SensorMountTest, AMountAtRestWhoseTfIsSlowIsWaitedForOnce) {
  SensorMount mount("base_link", 0.2, tf_.feed());
  sendPan(100.0, 0.3);
  for (int i = 0; i < 20'000; ++i) {
    if (i == 100) sendPan(101.0, 0.3 + 1e-6);  // noise of a joint
    EXPECT_NEAR(panOf(mount.find("camera", 100 * kSecond + i)), 0.3, 1e-5);
  }
  sendPan(102.0, 0.4);
  EXPECT_FALSE(mount.find("camera", 103 * kSecond)) << "it moves";
}

TEST_F(SensorMountTest, AMovingMountWhoseTfIsSlowIsExtrapolatedWithABound) {
  SensorMount mount("base_link", 0.2, tf_.feed());
  const auto panAt = [&](std::int64_t ms) { return panOf(mount.find("camera", ms * 1'000'000)); };
  sendPan(100.0, 0.0);
  EXPECT_NEAR(panAt(100'000), 0.0, 1e-9);
  sendPan(100.36, 0.36);
  const auto exact = mount.find("camera", 100'360'000'000);
  EXPECT_NEAR(panOf(exact), 0.36, 1e-9);
  EXPECT_TRUE(exact && exact->covariance.isZero());
  const auto begin = std::chrono::steady_clock::now();
  for (const int ms : {5, 10, 15, 20, 25, 30}) {
    EXPECT_EQ(mount.trouble(), "");
    EXPECT_NEAR(panAt(100'360 + ms), 0.36 + 1e-3 * ms, 1e-6);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(500))
      << "the next one is due later";
  const auto extrapolated = mount.find("camera", 100'400'000'000);
  ASSERT_TRUE(extrapolated);
  EXPECT_NEAR(std::sqrt(extrapolated->covariance(5, 5)), 0.04, 1e-6) << "the motion since 100.36 s";
  EXPECT_TRUE(std::isnan(panAt(100'600)));
  const std::string said =
      "tf from base_link to camera, which moves, comes at 2.8 Hz, too seldom for the images: "
      "publish it at their rate. Until then, pairs wait for it or are extrapolated, for up to 0.2 "
      "s "
      "each; others are dropped";
  EXPECT_EQ(mount.trouble(), said);
  EXPECT_EQ(log_.with(said).size(), 1u);
  for (int i = 1; i <= 50; ++i) {
    sendPan(101.0 + 0.1 * i, 0.0);
    panAt(101'000 + 100 * i);
  }
  EXPECT_EQ(mount.trouble(), "");
}

/// On a busy machine, with few pairs and late tf, most calls see a new transform.
TEST_F(SensorMountTest, SlowTfIsNotTakenForLate) {
  SensorMount mount("base_link", 0.02, tf_.feed());
  int sent = 0;
  for (int i = 0; i < 30; ++i) {
    const double stamp_s = 100.0 + 0.03 * i;
    for (; 0.037 * sent < 0.03 * i; ++sent) sendPan(100.0 + 0.037 * sent, 0.037 * sent);
    mount.find("camera", std::llround(1e9 * stamp_s));
  }
  EXPECT_NE(mount.trouble().find("comes at 27.0 Hz, too seldom"), std::string::npos)
      << mount.trouble();
}

/// Each pair gets its transform, but those that come while it waits replace each other.
TEST_F(SensorMountTest, LongWaitsAreTold) {
  SensorMount mount("base_link", 1000.0, tf_.feed());
  constexpr std::int64_t kInterval = 1'000'000;
  const auto findAt = [&](std::int64_t stamp_ns) { return mount.find("camera", stamp_ns); };
  sendPan(100.0, 0.0);
  EXPECT_TRUE(findAt(100 * kSecond));
  for (int i = 1; i <= 1000 && mount.trouble().empty(); ++i) {
    const std::int64_t stamp_ns = 100 * kSecond + 4 * i * kInterval;
    auto waiting = std::async(std::launch::async, findAt, stamp_ns - 3 * kInterval);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    sendPan(1e-9 * static_cast<double>(stamp_ns), 0.1 * i);
    EXPECT_TRUE(waiting.get());
    EXPECT_TRUE(findAt(stamp_ns));
  }
  EXPECT_NE(mount.trouble().find("comes at 250.0 Hz, too seldom"), std::string::npos)
      << mount.trouble();
}

/// As at a start, when images come before tf.
TEST_F(SensorMountTest, ATransformAfterTheImagesIsNotWaitedFor) {
  SensorMount mount("base_link", 1000.0, tf_.feed());
  sendPan(100.0, 0.3);
  EXPECT_NEAR(panOf(mount.find("camera", 99 * kSecond)), 0.3, 1e-9);
}

/// tf refuses transforms from 10 s before the latest.
TEST_F(SensorMountTest, GoesOnAfterATimeJump) {
  SensorMount mount("base_link", 0.0, tf_.feed());
  sendPan(100.0, 0.0);
  sendPan(101.0, 0.5);
  EXPECT_TRUE(mount.find("camera", 100 * kSecond));
  EXPECT_TRUE(mount.find("camera", 101 * kSecond));
  sendPan(20.0, 0.0);
  EXPECT_FALSE(mount.find("camera", 20 * kSecond));
  sendPan(20.0, 0.0);
  sendPan(21.0, 0.1);
  EXPECT_NEAR(panOf(mount.find("camera", 21 * kSecond)), 0.1, 1e-9);
}

TEST_F(SensorMountTest, AnotherFrameIsAnotherMountAndIsTold) {
  SensorMount mount("base_link", 0.0, tf_.feed());
  tf_.sendStatic("torso", "camera", panned(0.2));
  tf_.sendStatic("torso", "rear_camera", panned(M_PI / 2.0));
  EXPECT_NEAR(panOf(mount.find("camera", 5 * kSecond)), 0.2, 1e-12);
  EXPECT_NEAR(panOf(mount.find("rear_camera", 6 * kSecond)), M_PI / 2.0, 1e-12);
  ASSERT_EQ(log_.with("changed from camera to rear_camera").size(), 1u);
  // A driver that sends two frames in turn is told of at most every 5 s, and tf is listened to.
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(mount.find(i % 2 == 0 ? "camera" : "rear_camera", (7 + i) * kSecond));
  }
  EXPECT_EQ(tf_.listenersStarted(), 2);
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

TEST(ToEigenTest, RefusesWhatIsNone) {
  expectError([] { toEigen(makeTransform(NAN, 1.0, 0.0)); }, "the transform contains nan");
  expectError([] { toEigen(makeTransform(0.0, INFINITY, 0.0)); }, "the transform contains inf");
  expectError([] { toEigen(makeTransform(0.0, 0.0, 0.0)); }, "has the length 0, but must have 1");
  expectError([] { toEigen(makeTransform(0.0, 1.0, 1.0)); }, "has the length 1.41421");
}

}  // namespace
}  // namespace rotrocc
