#include "node/base/pair_processor.h"

#include <algorithm>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "support/log_recorder.h"
#include "support/odometry_rig.h"
#include "support/wait_until.h"

namespace rotrocc {
namespace {

constexpr double kStep_m = 0.4;

void darken(sensor_msgs::Image& left, sensor_msgs::Image& right) {
  left.data.assign(left.data.size(), 0);
  right.data.assign(right.data.size(), 0);
}

Eigen::Isometry3d forward(double x_m) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation().x() = x_m;
  return T;
}

/// With a search so short that only an expected motion finds one of several steps.
Parameters shortSearch() {
  Parameters parameters;
  parameters.odometry.max_tries = 1;
  parameters.odometry.correspondence_finder.feature_tracker.window_radius_px = 2;
  return parameters;
}

void skipPairs(OdometryRig& rig) {
  for (int i = 0; i < 3; ++i) rig.advance();
}

double xOf(const OdometryRig& rig) {
  return rig.answer()->state.T_odom_base.T.translation().x();
}

class PairProcessorTest : public testing::Test {
 protected:
  PairProcessorTest() {
    rig_.sendInfos();
    rig_.drivePairs(4);
  }

  double x() const { return xOf(rig_); }
  State state() const { return rig_.answer()->result.state; }

  OdometryRig rig_;
};

TEST_F(PairProcessorTest, ResetBeginsAtTheInitialPose) {
  EXPECT_NEAR(x(), 3 * kStep_m, 0.05);
  Parameters parameters;
  parameters.node.initial_pose = {5.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  OdometryRig rig(parameters);
  rig.sendInfos();
  rig.drivePairs(3);
  EXPECT_NEAR(xOf(rig), 5.0 + 2 * kStep_m, 0.05);
  rig.processor().requestReset();
  rig.drive();
  EXPECT_NEAR(xOf(rig), 5.0, 1e-12);
  EXPECT_EQ(rig.answer()->result.state, State::kInitializing);
  EXPECT_TRUE(rig.answer()->starts_trajectory);
  EXPECT_TRUE(rig.answer()->state.T_first_camera.isApprox(Eigen::Isometry3d::Identity()));
  rig.drive();
  EXPECT_EQ(rig.answer()->result.state, State::kOk);
  EXPECT_FALSE(rig.answer()->starts_trajectory);
  EXPECT_NEAR(xOf(rig), 5.0 + kStep_m, 0.05);
}

TEST_F(PairProcessorTest, RestartKeepsThePose) {
  const double before_m = x();
  rig_.processor().requestRestart();
  rig_.drive();
  EXPECT_EQ(state(), State::kInitializing);
  EXPECT_EQ(x(), before_m);
  EXPECT_FALSE(rig_.answer()->starts_trajectory);
}

TEST_F(PairProcessorTest, APoseMayBeSetBeforeTheFirstPair) {
  OdometryRig rig;
  rig.processor().requestPose({forward(7.0), Matrix6d::Zero()});
  rig.sendInfos();
  rig.drive();
  EXPECT_NEAR(xOf(rig), 7.0, 1e-12);
}

/// Matches that are all far away do not show swapped images.
TEST_F(PairProcessorTest, HintsComeFromTheConfigInEffect) {
  VisualOdometry::Config config;
  config.correspondence_finder.stereo_matcher.nearest_baselines = 100.0;
  const auto swapSides = [](sensor_msgs::Image& left, sensor_msgs::Image& right) {
    std::swap(left.data, right.data);
  };
  const auto hintOf = [&](const VisualOdometry::Config& changed) {
    rig_.processor().requestConfig(changed);
    for (int i = 0; i < PairInspector::kPatience + 1; ++i) rig_.drive(swapSides);
    return rig_.hint();
  };
  const std::string swapped = "swap their topics";
  EXPECT_EQ(hintOf(config).find(swapped), std::string::npos) << rig_.hint();
  EXPECT_NE(hintOf({}).find(swapped), std::string::npos) << rig_.hint();
}

TEST(TimeJumpTest, ItsStampsAreLoggedInFull) {
  const LogRecorder log;
  OdometryRig rig;
  rig.stamp = ros::Time(1317600010.0);
  rig.sendInfos();
  rig.drivePairs(3);
  rig.stamp = ros::Time(1317600000.0);
  rig.drivePairs(2);
  EXPECT_EQ(log.with("time jumped back from 1317600010.200 to 1317600000.000 s").size(), 1u);
}

/// The images are always the same, and the wheels may turn.
TEST(FrozenCameraTest, ItsPairsAreNoMeasurementsUnlessASimulatedBaseIsAtRest) {
  const std::vector<std::tuple<bool, std::optional<double>, State>> kCases = {
      {false, {}, State::kLost},
      {false, 0.0, State::kLost},
      {true, {}, State::kOk},
      {true, 0.0, State::kOk},
      {true, 0.2, State::kLost}};
  for (const auto& [is_simulated, wheels_m, expected] : kCases) {
    SCOPED_TRACE(testing::Message() << is_simulated << " " << wheels_m.value_or(-1.0));
    OdometryRig rig;
    rig.is_simulated = is_simulated;
    rig.sendInfos();
    rig.drivePairs(4);
    std::optional<std::pair<sensor_msgs::Image, sensor_msgs::Image>> frozen;
    const auto freeze = [&](sensor_msgs::Image& left, sensor_msgs::Image& right) {
      if (!frozen) frozen = {left, right};
      left.data = frozen->first.data;
      right.data = frozen->second.data;
    };
    rig.drive(freeze);
    const double before_m = xOf(rig);
    const double step_m = wheels_m.value_or(0.0);
    if (wheels_m) rig.expected = [=](auto, auto) { return forward(step_m); };
    for (int i = 0; i < PairInspector::kPatience + 1; ++i) rig.drive(freeze);
    const PairAnswer& answer = *rig.answer();
    EXPECT_EQ(answer.result.state, expected);
    const bool is_lost = expected == State::kLost;
    EXPECT_EQ(answer.state.twist.covariance(0, 0) == kUnknownVariance, is_lost);
    EXPECT_EQ(answer.result.reason.find("is the camera frozen") != std::string::npos, is_lost);
    EXPECT_NEAR(xOf(rig) - before_m, (PairInspector::kPatience + 1) * step_m, 0.05);
    EXPECT_EQ(rig.hint(), "");
    rig.expected = {};
    rig.drivePairs(4);
    EXPECT_EQ(rig.answer()->result.state, State::kOk) << rig.answer()->result.reason;
  }
}

/// After a lost pair, the next is compared with the one before. The wheels tell of all the way in
/// the first of the two steps, so the last one alone predicts nothing.
TEST_F(PairProcessorTest, ExpectedMotionsOfLostPairsAddUp) {
  OdometryRig rig(shortSearch());
  double step_m = 8 * kStep_m;
  rig.expected = [&](std::int64_t, std::int64_t) { return forward(std::exchange(step_m, 0.0)); };
  rig.sendInfos();
  rig.drive();
  skipPairs(rig);
  rig.drive(darken);
  EXPECT_EQ(rig.answer()->result.state, State::kLost);
  skipPairs(rig);
  rig.drive();
  EXPECT_EQ(rig.answer()->result.state, State::kOk) << rig.answer()->result.reason;
  EXPECT_NEAR(xOf(rig), 8 * kStep_m, 0.05);
}

TEST_F(PairProcessorTest, APoseThatIsSetWhileLostIsNotLost) {
  // Short enough that the pair before the loss would be recognized.
  rig_.drive(darken);
  EXPECT_EQ(state(), State::kLost);
  rig_.processor().requestPose({forward(30.0), Matrix6d::Zero()});
  rig_.drive();
  EXPECT_EQ(state(), State::kInitializing);
  EXPECT_NEAR(x(), 30.0, 1e-9);
  rig_.drive();
  EXPECT_EQ(state(), State::kOk);
  EXPECT_NEAR(x(), 30.0 + kStep_m, 0.05);
}

/// The state of each pair in the dark, as letters.
std::string statesInTheDark(OdometryRig& rig, int pairs) {
  std::string states;
  for (int i = 0; i < pairs; ++i) {
    rig.drive(darken);
    states += rig.answer()->result.state == State::kLost ? 'l' : 'i';
    if (rig.answer()->starts_trajectory) states += '!';
  }
  return states;
}

TEST_F(PairProcessorTest, RestartsAfterALongLossIfAsked) {
  Parameters parameters;
  parameters.node.reset_after_lost_s = 0.5;
  for (const bool keep : {true, false}) {
    parameters.node.pose_after_lost = keep ? "keep" : "initial";
    OdometryRig rig(parameters);
    rig.sendInfos();
    rig.drivePairs(3);
    EXPECT_EQ(statesInTheDark(rig, 13), keep ? "lllllilllllil" : "llllli!llllli!l") << keep;
    EXPECT_NEAR(xOf(rig), keep ? 2 * kStep_m : 0.0, 0.05);
  }
}

TEST_F(PairProcessorTest, DoesNotRestartAfterALongLossIfNotAsked) {
  EXPECT_EQ(statesInTheDark(rig_, 20), std::string(20, 'l'));
}

/// The images of a camera whose principal point is off, and its K.
class RawImages {
 public:
  explicit RawImages(int off_px) : off_px_(off_px) {}

  void operator()(sensor_msgs::CameraInfo& left, sensor_msgs::CameraInfo& right) const {
    for (sensor_msgs::CameraInfo* info : {&left, &right}) info->K[2] += off_px_;
  }

  /// Moves the pixels of each row; those that come in at its start have no meaning.
  void operator()(sensor_msgs::Image& left, sensor_msgs::Image& right) const {
    for (sensor_msgs::Image* image : {&left, &right}) {
      for (auto row = image->data.begin(); row != image->data.end(); row += image->step) {
        std::rotate(row, row + (image->step - off_px_), row + image->step);
      }
    }
  }

 private:
  unsigned off_px_;
};

TEST(RectifyTest, RawImagesAreRectifiedByTheCameraInfoOfTheirTime) {
  Parameters parameters;
  parameters.node.rectify = true;
  OdometryRig rig(parameters);
  for (const int off_px : {20, 20, 8, 20}) {
    const RawImages raw(off_px);
    sensor_msgs::Image rectified = rig.nextImage(StereoIntake::Side::kLeft);
    rig.sendInfos(raw);
    rig.drive(raw);
    ASSERT_TRUE(rig.answer());
    const cv::Mat& left = rig.left();
    const cv::Mat expected(left.size(), CV_8UC1, rectified.data.data(), rectified.step);
    const cv::Range seen(0, left.cols - off_px);
    EXPECT_EQ(cv::norm(left.colRange(seen), expected.colRange(seen), cv::NORM_INF), 0.0) << off_px;
  }
  EXPECT_EQ(rig.answer()->result.state, State::kOk);
  EXPECT_NEAR(xOf(rig), 3 * kStep_m, 0.05);
}

}  // namespace
}  // namespace rotrocc
