#include "node/health/diagnostics.h"

#include <gtest/gtest.h>

#include "rotrocc/OdometryStatus.h"

namespace rotrocc {
namespace {

using Level = diagnostic_msgs::DiagnosticStatus;

/// An odometry without faults.
HealthReport goodReport() {
  HealthReport report;
  int i = 0;
  static const char* const kTopics[] = {"/l/image", "/r/image", "/l/info", "/r/info"};
  for (TopicReport* topic : {&report.input.left_image,
                             &report.input.right_image,
                             &report.input.left_info,
                             &report.input.right_info}) {
    *topic = {kTopics[i++], 1, 50, 500, 10.0, 0.05};
  }
  report.input.recent_pairs = 50;
  report.input.pairs_silent_s = 0.05;
  report.input.together = {50, 50, 50};
  report.input.max_stamp_difference_s = report.input.tolerance_s = 0.01;
  report.input.stamp_difference_s = 0.002;
  report.answers = true;
  report.answer_rate_hz = 10.0;
  report.latency_p50_ms = 12.0;
  report.latency_p95_ms = 15.0;
  report.last_result.state = State::kOk;
  report.last_result.counts.rotation_inliers = 512;
  report.last_result.disparity_bias = {0.42, 0.05, 0.36};
  report.last_result.exposure_gain = 1.02;
  report.last_result.flow_noise_px = 0.15;
  return report;
}

std::string valueOf(const StatusWrapper& status, const std::string& key) {
  for (const auto& entry : status.values) {
    if (entry.key == key) return entry.value;
  }
  return "no such key";
}

TEST(StateOfTest, FollowsTheAnswersWhileTheyCome) {
  HealthReport report = goodReport();
  EXPECT_EQ(stateOf(report).state, OdometryStatus::OK);
  report.last_result.state = State::kLost;
  report.last_result.reason = "only 3 features";
  EXPECT_EQ(stateOf(report).state, OdometryStatus::LOST);
  EXPECT_EQ(stateOf(report).reason, "only 3 features");
  report.paused = true;
  EXPECT_EQ(stateOf(report).state, OdometryStatus::PAUSED);
}

TEST(StateOfTest, SaysWhatIsMissingWhileNoneCome) {
  HealthReport report = goodReport();
  report.answers = false;
  report.waits_for_tf = "no tf from base_link to camera";
  EXPECT_EQ(stateOf(report).state, OdometryStatus::NO_TF);
  EXPECT_EQ(stateOf(report).reason, "no tf from base_link to camera");
  report.not_of_camera = true;
  report.input.refused = "the images are 3x3 px";
  EXPECT_EQ(stateOf(report).state, OdometryStatus::NO_CALIBRATION);
  EXPECT_EQ(stateOf(report).reason, "the images are 3x3 px");
  report = goodReport();
  report.answers = false;
  report.input.waits_for_info = true;
  report.input.left_info.total = report.input.left_info.publishers = 0;
  EXPECT_EQ(stateOf(report).state, OdometryStatus::NO_CALIBRATION);
  EXPECT_NE(stateOf(report).reason.find("nobody publishes /l/info"), std::string::npos);
  report.input.left_image.recent = report.input.recent_pairs = 0;
  report.input.waits_for_info = false;
  EXPECT_EQ(stateOf(report).state, OdometryStatus::NO_INPUT);
}

TEST(StateOfTest, SaysAlwaysWhyThereIsNoInput) {
  HealthReport report = goodReport();
  report.answers = false;
  EXPECT_EQ(stateOf(report).state, OdometryStatus::NO_INPUT);
  EXPECT_EQ(stateOf(report).reason,
            "stereo pairs arrive, but none has been processed in the last 2 s");
  report.input.pairs_silent_s.reset();
  EXPECT_EQ(stateOf(report).reason, "no stereo pair has arrived yet");
  report.input.pairs_silent_s = 3.1;
  EXPECT_EQ(stateOf(report).reason, "no stereo pair for 3 s");
  report.input.left_image.silent_s = report.input.right_image.silent_s = 3.1;
  EXPECT_NE(stateOf(report).reason.find("/l/image has been silent for 3.1 s"), std::string::npos)
      << stateOf(report).reason;
}

TEST(StateOfTest, EveryStateHasAName) {
  EXPECT_STREQ(stateName(OdometryStatus::INITIALISING), "INITIALISING");
  EXPECT_STREQ(stateName(OdometryStatus::LOST), "LOST");
  EXPECT_STREQ(stateName(OdometryStatus::NO_TF), "NO_TF");
  EXPECT_STREQ(stateName(OdometryStatus::PAUSED), "PAUSED");
  EXPECT_STREQ(stateName(99), "unknown");
}

TEST(DiagnosticsTest, AllIsWell) {
  const HealthReport report = goodReport();
  StatusWrapper odometry, input, timing, tf, drops;
  describeOdometry(report, odometry);
  describeInput(report, input);
  describeTiming(report, timing);
  describeTf(report, tf);
  describeDrops(report, 0, drops);
  for (const StatusWrapper* status : {&odometry, &input, &timing, &tf, &drops}) {
    EXPECT_EQ(status->level, Level::OK) << status->message;
    EXPECT_FALSE(status->message.empty());
  }
  EXPECT_EQ(valueOf(odometry, "state"), "OK");
  EXPECT_EQ(valueOf(odometry, "disparity bias"), "0.42 +- 0.05 px, 0.36 px applied");
  EXPECT_EQ(valueOf(odometry, "contrast of the right image relative to the left one"), "1.02");
  EXPECT_EQ(valueOf(odometry, "flow noise"), "0.15 px");
  EXPECT_EQ(valueOf(odometry, "inliers of the rotation"), "512");
  EXPECT_EQ(valueOf(input, "/r/image"), "10.0 Hz, 50 in 5 s, 500 in total, 1 publishers");
  EXPECT_EQ(valueOf(input, "largest stamp difference of left and right"), "2.000 ms");
  EXPECT_EQ(valueOf(timing, "latency p50"), "12.0 ms");
  EXPECT_EQ(valueOf(timing, "latency p95"), "15.0 ms");
}

TEST(DiagnosticsTest, TellsWhyTheGyroscopeIsNotUsed) {
  HealthReport report = goodReport();
  StatusWrapper before;
  describeGyro(report, before);
  EXPECT_EQ(before.level, Level::OK);
  report.gyro.emplace();
  report.gyro->topic = "/imu";
  report.gyro->counts = {1000, 3, 50, 2};
  report.gyro->bias_rps = {0.01, -0.02, 0.0};
  report.gyro->bias_sigma_rps = 0.0005;
  StatusWrapper used;
  describeGyro(report, used);
  EXPECT_EQ(used.level, Level::OK);
  EXPECT_EQ(valueOf(used, "bias"), "0.0100 -0.0200 0.0000 rad/s, +- 0.0005");
  EXPECT_EQ(valueOf(used, "rotations predicted"), "50");
  EXPECT_EQ(valueOf(used, "samples refused"), "3");
  report.gyro->why_not_used = "no message on /imu";
  StatusWrapper missing;
  describeGyro(report, missing);
  EXPECT_EQ(missing.level, Level::WARN);
  EXPECT_EQ(missing.message, "not used: no message on /imu");
}

TEST(DiagnosticsTest, ALargeBiasAsksForACalibration) {
  HealthReport report = goodReport();
  report.last_result.disparity_bias = {-1.25, 0.05, -1.0};
  StatusWrapper status;
  describeOdometry(report, status);
  EXPECT_EQ(status.level, Level::WARN);
  EXPECT_NE(status.message.find("bias of 1.25 px (+- 0.05)"), std::string::npos) << status.message;
  EXPECT_NE(status.message.find("calibrate"), std::string::npos) << status.message;
}

TEST(DiagnosticsTest, RowsThatAreApartAskForACalibration) {
  HealthReport report = goodReport();
  report.last_result.row_offset = {-0.62, 0.01, 0.75};
  StatusWrapper status;
  describeOdometry(report, status);
  EXPECT_EQ(status.level, Level::WARN);
  EXPECT_NE(status.message.find("rows of left and right differ by 0.75 px"), std::string::npos)
      << status.message;
  EXPECT_EQ(status.message.find("disparities"), std::string::npos) << status.message;
  EXPECT_NE(status.message.find("calibrate"), std::string::npos) << status.message;
  EXPECT_EQ(valueOf(status, "row offset of the right image"),
            "-0.62 +- 0.01 px, median difference 0.75 px");
}

TEST(DiagnosticsTest, ATimeSkewBeyondDoubtIsAWarning) {
  HealthReport report = goodReport();
  report.last_result.time_skew = {-0.0062, 0.0011};
  StatusWrapper status;
  describeOdometry(report, status);
  EXPECT_EQ(status.level, Level::WARN);
  EXPECT_EQ(status.message,
            "the right images are taken 6.2 ms (+- 1.1) before the left ones: trigger both "
            "cameras by one signal");
  EXPECT_EQ(valueOf(status, "delay of the right image"), "-6.2 +- 1.1 ms");
  for (const TimeSkew& skew : {TimeSkew{-0.0062, 0.002}, TimeSkew{0.0015, 0.0002}, TimeSkew{}}) {
    report.last_result.time_skew = skew;
    EXPECT_EQ(rigWarning(report.last_result), "") << skew.estimated_s;
  }
}

TEST(DiagnosticsTest, LossIsAnErrorWithItsReason) {
  HealthReport report = goodReport();
  report.last_result.state = State::kLost;
  report.last_result.reason = "only 3 features";
  report.hint = "the lens is covered";
  StatusWrapper status;
  describeOdometry(report, status);
  EXPECT_EQ(status.level, Level::ERROR);
  EXPECT_NE(status.message.find("LOST: only 3 features"), std::string::npos) << status.message;
  EXPECT_EQ(valueOf(status, "hint"), "the lens is covered");
}

TEST(DiagnosticsTest, LostImagesAreAWarning) {
  HealthReport report = goodReport();
  report.input.right_image.rate_hz = 5.0;
  report.input.together = {50, 25, 25};
  StatusWrapper status;
  describeInput(report, status);
  EXPECT_EQ(status.level, Level::WARN);
  EXPECT_NE(status.message.find("/l/image arrives at 10.0 Hz, /r/image at 5.0 Hz"),
            std::string::npos)
      << status.message;
}

TEST(DiagnosticsTest, TheFirstImageOfASideIsNoFault) {
  HealthReport report = goodReport();
  report.input.right_image.rate_hz = 0.0;
  report.input.right_image.recent = report.input.right_image.total = report.input.recent_pairs = 1;
  report.input.together = {2, 1, 1};
  StatusWrapper status;
  describeInput(report, status);
  EXPECT_EQ(status.level, Level::OK) << status.message;
}

TEST(DiagnosticsTest, AGapIsAWarning) {
  HealthReport report = goodReport();
  report.input.right_image.silent_s = report.input.pairs_silent_s = 2.5;
  StatusWrapper status;
  describeInput(report, status);
  EXPECT_EQ(status.level, Level::WARN);
  EXPECT_NE(status.message.find("/r/image has been silent for 2.5 s"), std::string::npos)
      << status.message;
}

TEST(DiagnosticsTest, DropsBetweenPairsAreAWarning) {
  HealthReport report = goodReport();
  report.input.refused = "the left image has the stamp 0";
  StatusWrapper status;
  describeInput(report, status);
  EXPECT_EQ(status.level, Level::WARN);
  EXPECT_EQ(status.message, "dropped in the last 5 s: the left image has the stamp 0");
}

TEST(DiagnosticsTest, SilenceIsAnError) {
  HealthReport report = goodReport();
  report.input.recent_pairs = report.input.right_image.recent = 0;
  StatusWrapper status;
  describeInput(report, status);
  EXPECT_EQ(status.level, Level::ERROR);
  EXPECT_NE(status.message.find("/r/image has a publisher"), std::string::npos) << status.message;
}

TEST(DiagnosticsTest, SlownessIsAWarning) {
  HealthReport report = goodReport();
  report.latency_p50_ms = 130.0;
  StatusWrapper status;
  describeTiming(report, status);
  EXPECT_EQ(status.level, Level::WARN);
  EXPECT_NE(status.message.find("130.0 ms, but pairs arrive every 100.0 ms"), std::string::npos)
      << status.message;
}

TEST(DiagnosticsTest, NewDropsAreAWarningByReason) {
  HealthReport report = goodReport();
  report.drops = {{DropReason::kStampZero, 3}, {DropReason::kSuperseded, 4}};
  StatusWrapper status;
  describeDrops(report, 5, status);
  EXPECT_EQ(status.level, Level::WARN);
  EXPECT_EQ(status.message, "2 more dropped in the last second");
  EXPECT_EQ(valueOf(status, "stamp_zero"), "3");
  EXPECT_EQ(valueOf(status, "newer_pair_came"), "4");
  EXPECT_EQ(valueOf(status, "dropped in total"), "7");
  StatusWrapper later;
  describeDrops(report, 7, later);
  EXPECT_EQ(later.level, Level::OK);
}

TEST(DiagnosticsTest, AnotherParentOfTheBaseIsAWarning) {
  HealthReport report = goodReport();
  report.tf_conflict = "node /ekf publishes tf odom -> base_link";
  StatusWrapper status;
  describeTf(report, status);
  EXPECT_EQ(status.level, Level::WARN);
  EXPECT_EQ(status.message, report.tf_conflict);
}

TEST(OdometryHealthTest, AFaultOfTheInputIsAHintIfTheCamerasHaveNone) {
  OdometryHealth health;
  const DropLog drops;
  health.addAnswer({}, "", 1.0);
  EXPECT_EQ(health.report({}, drops).statusHint(), "");
  health.setInputFault("30 % of the images have no partner");
  EXPECT_EQ(health.report({}, drops).statusHint(), "30 % of the images have no partner");
  EXPECT_EQ(health.report({}, drops).hint, "");
  health.addAnswer({}, "the lens is covered", 1.0);
  EXPECT_EQ(health.report({}, drops).statusHint(), "the lens is covered");
}

TEST(DiagnosticsTest, AGuessFrameThatIsNotInTfIsAWarning) {
  OdometryHealth health;
  health.setGuess("no tf from guess_frame wheel_odom", 7);
  StatusWrapper status;
  describeTf(health.report({}, DropLog()), status);
  EXPECT_EQ(status.level, Level::WARN);
  EXPECT_EQ(status.message, "no tf from guess_frame wheel_odom");
  EXPECT_EQ(valueOf(status, "pairs without the motion of guess_frame"), "7");
}

TEST(OdometryHealthTest, CountsAnswersAndTheirLatency) {
  OdometryHealth health;
  const DropLog drops;
  EXPECT_FALSE(health.report({}, drops).answers);
  OdometryResult result;
  result.state = State::kLost;
  for (int i = 1; i <= 100; ++i) health.addAnswer(result, "", i);
  const HealthReport report = health.report({}, drops);
  EXPECT_TRUE(report.answers);
  EXPECT_EQ(report.pairs_processed, 100u);
  EXPECT_EQ(report.pairs_lost, 100u);
  EXPECT_EQ(report.latency_p50_ms, 50.0);
  EXPECT_EQ(report.latency_p95_ms, 95.0);
  EXPECT_EQ(report.latency_max_ms, 100.0);
}

}  // namespace
}  // namespace rotrocc
