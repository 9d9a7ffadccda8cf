#include "node/health/diagnostics.h"

#include <gtest/gtest.h>

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
  report.input.unmatched = {0, 0, 50};
  report.input.max_stamp_difference_s = report.input.tolerance_s = 0.01;
  report.input.skew = StampSkew{0.002, {}, {}};
  report.answers = true;
  report.answer_rate_hz = 10.0;
  report.latency_p50_ms = 12.0;
  report.latency_p95_ms = 15.0;
  report.state = OdometryStatus::OK;
  OdometryResult& result = report.pair.result;
  result.state = State::kOk;
  result.counts.rotation_inliers = 512;
  result.disparity_bias = {0.42, 0.05, 0.36};
  result.contrast_gain = 1.02;
  result.flow_noise_px = 0.15;
  return report;
}

std::string valueOf(const StatusWrapper& status, const std::string& key) {
  for (const auto& entry : status.values) {
    if (entry.key == key) return entry.value;
  }
  return "no such key";
}

void expectPart(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << text << "' lacks '" << part << "'";
}

/// `reason`: a part of it.
void expectState(HealthReport report, const char* state, const std::string& reason) {
  updateState(report);
  EXPECT_STREQ(stateName(report.state), state);
  expectPart(report.reason, reason);
}

TEST(UpdateStateTest, FollowsTheAnswersWhileTheyCome) {
  HealthReport report = goodReport();
  expectState(report, "OK", "");
  report.state = OdometryStatus::LOST;
  report.reason = "only 3 features";
  expectState(report, "LOST", "only 3 features");
  report.paused = true;
  expectState(report, "PAUSED", "~pause");
}

TEST(UpdateStateTest, SaysWhatIsMissingWhileNoneCome) {
  HealthReport silent = goodReport();
  silent.answers = false;
  expectState(silent, "NO_INPUT", "none has been processed in the last 2 s");
  HealthReport report = silent;
  report.waits_for_tf = "no tf from base_link to camera";
  expectState(report, "NO_TF", "no tf from base_link to camera");
  report.input.camera_error = "P is all zeros";
  expectState(report, "NO_CALIBRATION", "P is all zeros");
  report = silent;
  report.input.waits_for_info = true;
  report.input.left_info.total = report.input.left_info.recent = 0;
  report.input.left_info.publishers = 0;
  expectState(report, "NO_CALIBRATION", "nobody publishes /l/info");
  report = silent;
  report.input.left_image.recent = report.input.recent_pairs = 0;
  expectState(report, "NO_INPUT", "/l/image has a publisher");
  report = silent;
  report.input.pairs_silent_s.reset();
  expectState(report, "NO_INPUT", "no stereo pair has arrived yet");
  report.input.pairs_silent_s = 3.1;
  expectState(report, "NO_INPUT", "no stereo pair for 3 s");
  report.input.left_image.silent_s = report.input.right_image.silent_s = 3.1;
  expectState(report, "NO_INPUT", "/l/image has been silent for 3.1 s");
}

using Describe = void(const HealthReport&, StatusWrapper&);

/// Of 5 drops, none is new.
void describeNewDrops(const HealthReport& report, StatusWrapper& status) {
  describeDrops(report, 5, status);
}

/// Expects level and a part of the message. Returns the entry.
StatusWrapper expectEntry(Describe* describe,
                          const HealthReport& report,
                          unsigned char level,
                          const std::string& message) {
  StatusWrapper status;
  describe(report, status);
  EXPECT_EQ(status.level, level) << message;
  expectPart(status.message, message);
  return status;
}

HealthReport withDrops(std::uint64_t zero_stamps, std::uint64_t superseded) {
  HealthReport report = goodReport();
  report.drops = {{DropReason::kStampZero, zero_stamps}, {DropReason::kSuperseded, superseded}};
  return report;
}

TEST(DiagnosticsTest, AllIsWell) {
  const HealthReport report = goodReport();
  const StatusWrapper odometry = expectEntry(describeOdometry, report, Level::OK, "OK");
  EXPECT_EQ(valueOf(odometry, "state"), "OK");
  const StatusWrapper input = expectEntry(describeInput, report, Level::OK, "stereo pairs arrive");
  EXPECT_EQ(valueOf(input, "/r/image"), "10.0 Hz, 50 in 5 s, 500 in total, 1 publishers");
  EXPECT_EQ(valueOf(input, "largest left-right stamp difference"), "2.000 ms");
  const StatusWrapper timing =
      expectEntry(describeTiming, report, Level::OK, "10.0 results per second");
  EXPECT_EQ(valueOf(timing, "latency p50"), "12.0 ms");
  EXPECT_EQ(valueOf(timing, "latency p95"), "15.0 ms");
  expectEntry(describeTf, report, Level::OK, "no conflict");
  expectEntry(describeNewDrops, withDrops(3, 2), Level::OK, "none since the last report");
}

/// The fault of the rig after three seconds of pairs of one result, and one of another.
std::string rigFault(const OdometryResult& result, const OdometryResult& last) {
  OdometryHealth health;
  const DropLog drops;
  PairReport pair;
  pair.result = result;
  TopicStatistics::Time now;
  for (int i = 0; i < 30; ++i) health.addPair(pair, drops, now += std::chrono::milliseconds(100));
  pair.result = last;
  return health.addPair(pair, drops, now).rig_fault;
}

std::string rigFault(const OdometryResult& result) {
  return rigFault(result, result);
}

OdometryResult biased(double bias_px, double sigma_px) {
  OdometryResult result = goodReport().pair.result;
  result.disparity_bias = {-bias_px, sigma_px, -bias_px};
  return result;
}

TEST(RigFaultTest, FaultsThatLastAskForACalibration) {
  const std::string advice = ": recalibrate the stereo rig";
  const std::string bias =
      "disparities have a bias of 1.25 px (+- 0.05), which is corrected" + advice;
  EXPECT_EQ(rigFault(biased(1.25, 0.05)), bias);
  EXPECT_EQ(rigFault(biased(1.25, 0.05), OdometryResult()), bias) << "while lost";
  EXPECT_EQ(rigFault(goodReport().pair.result, biased(1.25, 0.05)), "") << "of one pair";
  EXPECT_EQ(rigFault(biased(1.25, 0.05), biased(0.0, 0.05)), "") << "it is gone";
  EXPECT_EQ(rigFault(biased(4.07, 1.11)), "") << "3.7 standard deviations";
  HealthReport report = goodReport();
  report.rig_fault = bias;
  expectEntry(describeOdometry, report, Level::WARN, bias);

  report.pair.result.row_offset.median_px = -0.62;
  report.pair.result.row_offset.sigma_px = 0.01;
  report.pair.result.row_offset.typical_px = 0.75;
  EXPECT_EQ(rigFault(report.pair.result),
            "rows of left and right differ by 0.75 px, with a median offset of -0.62 px (+- 0.01)" +
                advice);
  report.pair.result.row_offset = {-0.36, 0.21, 1.75, 0.0};
  EXPECT_EQ(rigFault(report.pair.result), "") << "chance matches of a few features";

  report.pair.result.right_delay = {-0.005, 0.00125, -0.004};
  const std::string delay =
      "right images are taken -5 ms (+- 1.25) after the left ones, which is corrected: trigger "
      "both cameras together";
  EXPECT_EQ(rigFault(report.pair.result), delay);
  report.pair.result.right_delay.sigma_s = 0.00126;
  EXPECT_EQ(rigFault(report.pair.result), "") << "less than 4 standard deviations";
  OdometryResult both = biased(1.25, 0.05);
  both.right_delay = {0.005, 0.001, 0.005};
  EXPECT_NE(rigFault(both).find(advice + "; right images are taken 5 ms"), std::string::npos);
}

TEST(DiagnosticsTest, LossIsAnErrorWithItsReason) {
  HealthReport report = goodReport();
  report.state = OdometryStatus::LOST;
  report.reason = "only 3 features";
  report.pair.camera_fault = "the lens is covered";
  const StatusWrapper status =
      expectEntry(describeOdometry, report, Level::ERROR, "LOST: only 3 features");
  EXPECT_EQ(valueOf(status, "hint"), "the lens is covered");
}

TEST(DiagnosticsTest, FaultsOfTheInputAreReported) {
  HealthReport lossy = goodReport();
  lossy.input.right_image.rate_hz = 5.0;
  lossy.input.unmatched = {25, 0, 25};
  lossy.input_fault = faultOfPairs(lossy.input).value_or("");
  const std::string rates = "/l/image arrives at 10.0 Hz, /r/image at 5.0 Hz";
  expectEntry(describeInput, lossy, Level::WARN, rates);
  HealthReport first = goodReport();
  first.input.right_image.rate_hz = 0.0;
  first.input.right_image.recent = first.input.right_image.total = first.input.recent_pairs = 1;
  first.input.unmatched = {1, 0, 1};
  expectEntry(describeInput, first, Level::OK, "stereo pairs arrive");
  HealthReport gap = goodReport();
  gap.input.right_image.silent_s = gap.input.pairs_silent_s = 2.5;
  expectEntry(describeInput, gap, Level::WARN, "/r/image has been silent for 2.5 s");
  HealthReport rejected = goodReport();
  rejected.input.rejected = "the left image has the stamp 0";
  const std::string dropped = "dropped in the last 5 s: the left image has the stamp 0";
  expectEntry(describeInput, rejected, Level::WARN, dropped);
  HealthReport replay = goodReport();
  replay.input.stamp_age_s = 1e8;
  expectEntry(describeInput, replay, Level::OK, "a replay without --clock");
  HealthReport silent = goodReport();
  silent.input.recent_pairs = silent.input.right_image.recent = 0;
  expectEntry(describeInput, silent, Level::ERROR, "/r/image has a publisher");
}

TEST(DiagnosticsTest, SlownessDropsAndFaultsOfTfAreWarnings) {
  HealthReport slow = goodReport();
  slow.latency_p50_ms = 130.0;
  expectEntry(describeTiming,
              slow,
              Level::WARN,
              "130.0 ms, but pairs arrive every 100.0 ms; they wait for tf");
  slow.latency_without_tf_p50_ms = 120.0;
  expectEntry(describeTiming, slow, Level::WARN, "every 100.0 ms; reduce feature_detector/");
  StatusWrapper status = expectEntry(
      describeNewDrops, withDrops(3, 4), Level::WARN, "2 more dropped since the last report");
  EXPECT_EQ(valueOf(status, "stamp_zero"), "3");
  EXPECT_EQ(valueOf(status, "newer_pair_came"), "4");
  EXPECT_EQ(valueOf(status, "dropped in total"), "7");
  HealthReport conflict = goodReport();
  conflict.tf_conflict = "node /ekf publishes tf odom -> base_link";
  expectEntry(describeTf, conflict, Level::WARN, conflict.tf_conflict);
  HealthReport guess = goodReport();
  guess.pair.tf_problem = "no tf from guess_frame wheel_odom";
  guess.pair.status.guess_misses = 7;
  status = expectEntry(describeTf, guess, Level::WARN, guess.pair.tf_problem);
  EXPECT_EQ(valueOf(status, "pairs without a motion from guess_frame or guess_topic"), "7");
}

TEST(DiagnosticsTest, ReportsWhyTheGyroscopeIsNotUsed) {
  GyroPredictor gyro;
  const auto describe = [&gyro] {
    StatusWrapper status;
    describeGyro(gyro, "/imu", status);
    return status;
  };
  EXPECT_EQ(describe().level, Level::OK) << "no pair yet";
  gyro.add({0, {0.0, 0.0, 0.0}});
  gyro.add({10'000'000, {0.0, 0.0, 0.0}});
  gyro.reject("no stamp");
  ASSERT_TRUE(gyro.rotation(0, 10'000'000));
  EXPECT_EQ(describe().level, Level::OK);
  EXPECT_EQ(describe().message, "predicts rotations");
  EXPECT_EQ(valueOf(describe(), "bias").find("0.0000 0.0000 0.0000 rad/s, +- "), 0u);
  EXPECT_EQ(valueOf(describe(), "rotations predicted"), "1");
  EXPECT_EQ(valueOf(describe(), "samples rejected"), "1");
  gyro.miss("no message on /imu");
  EXPECT_EQ(describe().level, Level::WARN);
  EXPECT_EQ(describe().message, "not used: no message on /imu");
}

TEST(OdometryHealthTest, TheHintIsAFaultOfTheCamerasOrElseOfTheInputAndOfTf) {
  OdometryHealth health;
  const DropLog drops;
  InputReport lossy = goodReport().input;
  lossy.unmatched = {25, 0, 25};
  const auto hint = [&](const std::string& camera_fault, const std::string& tf_problem) {
    PairReport pair;
    pair.camera_fault = camera_fault;
    pair.tf_problem = tf_problem;
    return toStatus(health.addPair(pair, drops)).hint;
  };
  EXPECT_EQ(hint("", ""), "");
  EXPECT_EQ(hint("", "no tf from guess_frame"), "no tf from guess_frame");
  const auto now = std::chrono::steady_clock::now();
  EXPECT_EQ(health.report(lossy, drops, now).pair.camera_fault, "");
  EXPECT_EQ(hint("", ""), "") << "it may have just begun";
  health.report(lossy, drops, now + TopicStatistics::kWindow + std::chrono::seconds(1));
  EXPECT_EQ(hint("", "").find("50 % of the images have no partner"), 0u);
  EXPECT_EQ(hint("frozen?", "no tf from guess_frame"), "frozen?; no tf from guess_frame");
}

TEST(OdometryHealthTest, CountsAnswersTheirLatencyAndDrops) {
  OdometryHealth health;
  DropLog drops;
  EXPECT_FALSE(health.report({}, drops).answers);
  drops.count(DropReason::kStampZero, 5);
  PairReport pair;  // lost
  for (int i = 1; i <= 100; ++i) {
    pair.status.latency_ms = static_cast<float>(i);
    EXPECT_EQ(health.addPair(pair, drops).pairs_lost, static_cast<std::uint64_t>(i));
  }
  const HealthReport report = health.report({}, drops);
  EXPECT_TRUE(report.answers);
  EXPECT_EQ(report.pairs_processed, 100u);
  EXPECT_EQ(report.drops, drops.counts());
  EXPECT_EQ(report.latency_p50_ms, 50.0);
  EXPECT_EQ(report.latency_p95_ms, 95.0);
  EXPECT_EQ(report.latency_max_ms, 100.0);
}

TEST(StatusTest, HasAllOfAPairAndWithoutOneTheStateHintAndCounters) {
  HealthReport report;
  report.state = OdometryStatus::DEGRADED;
  report.reason = "few inliers";
  report.pairs_processed = 9;
  report.pairs_lost = 7;
  report.drops = {{DropReason::kStampZero, 5}};
  PairReport& pair = report.pair;
  pair.status.header.frame_id = "camera";
  pair.camera_fault = "frozen?";
  pair.status.guess_misses = 3;
  pair.status.imu_reason = "no message on /imu";
  pair.status.rotations_predicted = 1;
  pair.status.rotations_missed = 2;
  pair.status.latency_ms = 12.0f;
  OdometryResult& result = pair.result;
  result.stamp_ns = 5'000'000'000;
  result.prev_stamp_ns = 4'900'000'000;
  result.counts = {7, 6, 4, 3, 2, 1, 2};
  result.times.tracking_ms = 1.5;
  result.times.total_ms = 2.0;
  result.disparity_bias = {0.75, 0.125, 0.5};
  result.row_offset = {-0.25, 0.0625, 0.375, -0.5};
  result.right_delay = {0.25, 0.125, 0.375};
  result.contrast_gain = 0.625;
  result.halvings = 1;
  result.flow_noise_px = 0.125;
  const OdometryStatus idle = toIdleStatus(report, ros::Time(7, 0));
  OdometryStatus expected = idle;
  expected.header.stamp = ros::Time(5, 0);
  expected.header.frame_id = "camera";
  expected.dt_s = 0.1;
  expected.corners = 7;
  expected.with_depth = 6;
  expected.tracked = 4;
  expected.consistent = 3;
  expected.rotation_inliers = 2;
  expected.translation_inliers = 1;
  expected.tries = 2;
  expected.tracking_ms = 1.5f;
  expected.estimator_ms = 2.0f;
  expected.latency_ms = 12.0f;
  expected.right_delay_s = 0.25f;
  expected.right_delay_sigma_s = 0.125f;
  expected.right_delay_applied_s = 0.375f;
  expected.disparity_bias_px = 0.75f;
  expected.disparity_bias_sigma_px = 0.125f;
  expected.disparity_bias_applied_px = 0.5f;
  expected.row_offset_px = -0.25f;
  expected.row_offset_sigma_px = 0.0625f;
  expected.row_offset_applied_px = -0.5f;
  expected.row_difference_px = 0.375f;
  expected.contrast_gain = 0.625f;
  expected.halvings = 1;
  expected.flow_noise_px = 0.125f;
  EXPECT_EQ(toStatus(report), expected);

  EXPECT_EQ(idle.header.stamp, ros::Time(7, 0));
  EXPECT_EQ(idle.state, OdometryStatus::DEGRADED);
  EXPECT_EQ(idle.reason, "few inliers");
  EXPECT_EQ(idle.hint, "frozen?");
  EXPECT_EQ(idle.imu_reason, "no message on /imu");
  EXPECT_EQ(idle.rotations_predicted, 1u);
  EXPECT_EQ(idle.rotations_missed, 2u);
  EXPECT_EQ(idle.pairs_processed, 9u);
  EXPECT_EQ(idle.pairs_lost, 7u);
  EXPECT_EQ(idle.guess_misses, 3u);
  ASSERT_EQ(idle.drops.size(), 1u);
  EXPECT_EQ(idle.drops[0].reason, "stamp_zero");
  EXPECT_EQ(idle.drops[0].count, 5u);
}

}  // namespace
}  // namespace rotrocc
