#include "inertial/gyro_trust.h"

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

constexpr GyroTrust::Comparison kGood = {0.001, 0.001, 0.05, 0.05};
constexpr GyroTrust::Comparison kWrong = {0.06, 0.001, 0.05, 0.05};

void compare(GyroTrust& trust, const GyroTrust::Comparison& comparison, int times) {
  for (int i = 0; i < times; ++i) trust.compare(comparison);
}

TEST(GyroTrustTest, OneWrongMotionIsNoReason) {
  GyroTrust trust;
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(trust.compare(kWrong));
    EXPECT_TRUE(trust.compare(kGood));
  }
  compare(trust, {0.06, 0.03, 0.05, 0.05}, 20);  // within the uncertainty
  EXPECT_EQ(trust.whyNot(), std::nullopt);
}

TEST(GyroTrustTest, SeveralInARowAre) {
  GyroTrust trust;
  compare(trust, kWrong, 5);
  EXPECT_EQ(trust.whyNot(),
            "its rotations differ from those of the images by 3.4 deg per pair: check the tf "
            "from its frame to the camera's, and its stamps");
}

TEST(GyroTrustTest, RecognisesDegrees) {
  GyroTrust trust;
  const double vision_rad = 0.05;
  const double gyro_rad = 57.3 * vision_rad;
  compare(trust, {gyro_rad - vision_rad, 0.001, gyro_rad, vision_rad}, 5);
  EXPECT_EQ(
      trust.whyNot(),
      "its rotations are 57.3 times those of the images: it seems to be in deg/s, but must be "
      "in rad/s");
}

TEST(GyroTrustTest, ComesBackByRotationsThatAgree) {
  GyroTrust trust;
  compare(trust, kWrong, 5);
  compare(trust, {0.0005, 0.001, 0.0005, 0.0}, 1000);  // a standstill tells nothing
  EXPECT_NE(trust.whyNot(), std::nullopt);
  compare(trust, kGood, 4);
  compare(trust, kWrong, 1);
  compare(trust, kGood, 4);
  EXPECT_NE(trust.whyNot(), std::nullopt);
  compare(trust, kGood, 1);
  EXPECT_EQ(trust.whyNot(), std::nullopt);
}

}  // namespace
}  // namespace rotrocc
