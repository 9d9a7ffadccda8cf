#include "check/rig_check.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "bags/recorded_pairs.h"
#include "check/disparity_check.h"
#include "check/input_check.h"
#include "check/replay_check.h"
#include "check/row_check.h"
#include "common/to_seconds.h"
#include "input/camera_calibration.h"
#include "input/input_error.h"
#include "input/to_text.h"
#include "node/health/pair_inspector.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {
namespace {

/// With half as many features again: a check may take longer than the odometry.
OdometryConfig configOf(const RigCheckOptions& options) {
  OdometryConfig config = options.parameters.odometry;
  int& features = config.correspondence_finder.feature_detector.max_features;
  features += features / 2;
  return config;
}

/// All checks of the pairs of one recording.
class PairChecks {
 public:
  PairChecks(const OdometryConfig& config,
             const std::optional<GyroRecording>& gyroscope,
             int pairs,
             bool rectifies)
      : odometry_(config),
        inspector_(config, rectifies),
        rows_(config),
        view_(makeViewCheck(config)),
        replay_(config, pairs) {
    if (gyroscope) gyro_ = makeGyroCheck(*gyroscope);
  }

  void observe(const StereoPair& pair, const StereoCamera& camera) {
    if (pairs_ == 0) first_ns_ = pair.stamp_ns;
    if (pairs_ > 0 && pair.time_ns() <= last_ns_) odometry_.reset();
    last_ns_ = pair.time_ns();
    ++pairs_;
    const OdometryResult result = odometry_.process(pair, camera);
    camera_ = camera;
    with_motion_ += result.hasMotion() ? 1 : 0;
    ok_ += result.state == State::kOk ? 1 : 0;
    path_m_ += result.T_prev_cur.translation().norm();
    const CheckedPair checked = {toSeconds(pair.stamp_ns - first_ns_),
                                 pair,
                                 camera,
                                 result,
                                 odometry_.correspondences(),
                                 odometry_.rotationInliers()};
    if (result.state == State::kLost) why_lost_ = result.reason;
    if (const std::string fault =
            inspector_.inspect(pair, camera, result, {}, [&] { return before_; });
        !fault.empty()) {
      fault_ = fault;
      is_of_no_pair_ = inspector_.isOfNoPair();
    }
    before_.push_back(copyOf(pair));
    if (before_.size() > 2) before_.erase(before_.begin());
    photometry_->observe(checked);
    rows_.observe(checked);
    disparities_.observe(checked);
    view_->observe(checked);
    if (gyro_) gyro_->observe(checked);
    replay_.observe(checked);
    keepSample(pair, result);
  }

  void report(CheckedRig& rig) {
    RigReport& report = rig.report;
    const double length_s = toSeconds(last_ns_ - first_ns_);
    const Windows windows(0.0, length_s, static_cast<std::size_t>(pairs_));
    report.summary = toText(pairs_) + " pairs in " + fixedText(length_s, 1) + " s, " +
                     fixedText(path_m_, 1) + " m; " + sizeText(camera_.width, camera_.height) +
                     ", focal length " + fixedText(camera_.fx, 1) + " px, baseline " +
                     fixedText(camera_.baseline_m, 3) + " m";
    addFault(report);
    if (!isMostlyLost()) {
      photometry_->report(windows, report);
      rows_.report(windows, disparities_.keystone_rad(), report);
      disparities_.report(windows, report);
      if (gyro_) gyro_->report(windows, report);
      view_->report(windows, report);
      replay_.report(report);
      isExplained() ? doubt(report) : addRectification(report);
    }
    if (with_motion_ < kLeastMotions) addTooShort(report);
    report.tables.push_back({"image",
                             "width,height,fx,cx,cy",
                             {{static_cast<double>(camera_.width),
                               static_cast<double>(camera_.height),
                               camera_.fx,
                               camera_.cx,
                               camera_.cy}}});
    report.left = left_;
    report.right = right_;
    rig.measures.rows = rows_.correctable();
    rig.measures.rows_rms_px = rows_.rms_px();
    rig.measures.rows_are_constant = rows_.isConstant();
    rig.measures.bias = disparities_.bias();
    rig.measures.replay_share = replay_.share();
    rig.measures.pairs_with_motion = with_motion_;
  }

  const StereoCamera& camera() const { return camera_; }
  int pairs() const { return pairs_; }

 private:
  bool isMostlyLost() const { return 2 * with_motion_ < pairs_; }

  /// Whether most motions are in doubt because the images are no pairs.
  bool isExplained() const { return is_of_no_pair_ && 2 * ok_ < pairs_; }

  /// One pair with a motion, of about the middle: later ones replace it ever more seldom.
  void keepSample(const StereoPair& pair, const OdometryResult& result) {
    const bool is_better = left_.empty() || (result.hasMotion() && with_motion_ >= next_sample_);
    if (!is_better) return;
    left_ = pair.left.clone();
    right_ = pair.right.clone();
    next_sample_ = 2 * std::max(with_motion_, 1);
  }

  /// What is not good in the sections of measurements is unknown.
  static void doubt(RigReport& report) {
    for (Finding& finding : report.findings) {
      if (finding.section == "inputs" || finding.section == "photometry") continue;
      if (finding.verdict != Verdict::kGood) finding.verdict = Verdict::kUnknown;
    }
  }

  void addTooShort(RigReport& report) const {
    doubt(report);
    report.findings.push_back(
        {"inputs",
         "length of the recording",
         "motion in " + toText(with_motion_) + " of " + toText(pairs_) + " pairs",
         "each has errors of its own, so that a rig is not known by a few",
         "record a minute of motion, with turns",
         Verdict::kUnknown,
         100.0});
  }

  /// Errors so large that they are not those of a calibration. What follows from them is not told.
  void addRectification(RigReport& report) const {
    constexpr double kMostRemainder_px = 0.35;
    constexpr double kMostBias_px = 4.0;
    const double bias_px = std::abs(disparities_.bias().estimated_px);
    if (rows_.remainder_px() < kMostRemainder_px && bias_px < kMostBias_px) return;
    doubt(report);
    report.findings.push_back({"inputs",
                               "rectification",
                               "rows differ by " + fixedText(rows_.rms_px(), 2) +
                                   " px (rms), of which " + fixedText(rows_.remainder_px(), 2) +
                                   " px are of no shape that a pair of rectified cameras has; "
                                   "disparities have a bias of " +
                                   fixedText(bias_px, 1) + " px",
                               "depths and motions are wrong, however many features agree",
                               "the images are not rectified, or by another calibration: take the "
                               "topics `image_rect`, or set `rectify` for raw ones; otherwise "
                               "calibrate the pair",
                               Verdict::kFix,
                               100.0});
  }

  void addFault(RigReport& report) {
    inspector_.finish();
    if (with_motion_ == 0 && !left_.empty()) {
      // The search was for the pairs before; what it found comes with the next one.
      OdometryResult lost;
      lost.counts.tries = 1;
      const std::string found = inspector_.inspect({last_ns_, left_, right_}, camera_, lost);
      if (!found.empty()) fault_ = found;
    }
    if (fault_.empty() && isMostlyLost()) fault_ = why_lost_;
    if (fault_.empty()) return;
    const bool matters = isMostlyLost() || isExplained();
    const std::size_t colon = fault_.find(": ");
    report.findings.push_back({"inputs",
                               "images of left and right",
                               fault_.substr(0, colon),
                               toText(pairs_ - ok_) + " of " + toText(pairs_) +
                                   " pairs have no motion, or one in doubt" +
                                   (isMostlyLost() ? ", so that nothing else can be measured" : ""),
                               colon == std::string::npos ? "" : fault_.substr(colon + 2),
                               matters ? Verdict::kFix : Verdict::kAcceptable,
                               matters ? 100.0 : 0.9});
  }

  VisualOdometry odometry_;
  PairInspector inspector_;
  std::vector<StereoPair> before_;  // the last two
  std::unique_ptr<PairCheck> photometry_ = makePhotometryCheck();
  RowCheck rows_;
  DisparityCheck disparities_;
  std::unique_ptr<PairCheck> gyro_;  // null: without a gyroscope
  std::unique_ptr<PairCheck> view_;
  ReplayCheck replay_;
  StereoCamera camera_;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  int pairs_ = 0, with_motion_ = 0, ok_ = 0, next_sample_ = 1;
  double path_m_ = 0.0;
  std::string fault_, why_lost_;
  bool is_of_no_pair_ = false;
  cv::Mat left_, right_;
};

/// The baseline that P of the first camera_info has, whatever its sign; 0 if it has none.
double sizeOfBaseline(const Recording& recording) {
  const RecordedMessage infos = recording.firstInfos();
  const auto& left = infos.left_info->P;
  const auto& right = infos.right_info->P;
  return left[0] > 0.0 ? std::abs(left[3] - right[3]) / left[0] : 0.0;
}

StereoCalibration calibrationOf(const Recording& recording,
                                const StereoCamera& camera,
                                bool rectifies,
                                const RigCheckOptions& options) {
  if (options.calibration) return *options.calibration;
  if (!rectifies) return rectifiedCalibration(camera);
  const RecordedMessage infos = recording.firstInfos();
  return toStereoCalibration(*infos.left_info, *infos.right_info, camera.baseline_m);
}

void addUnusable(const std::string& why, RigReport& report) {
  if (!report.findings.empty()) return;  // it is known
  const std::size_t end = why.rfind(": ");
  report.findings.push_back({"inputs",
                             "pairs",
                             why.substr(0, end),
                             "no pair can be used",
                             end == std::string::npos ? "" : why.substr(end + 2),
                             Verdict::kFix,
                             1000.0});
}

/// Returns false, with a finding, if there is no pair that can be used.
bool checkPairs(Recording& recording, const RigCheckOptions& options, CheckedRig& rig) {
  RecordedPairs pairs(recording, options.parameters.node, options.rectify, options.calibration);
  InputCheck input;
  pairs.onMessage([&](const RecordedMessage& message) { input.observe(message); });
  PairChecks checks(configOf(options), options.gyroscope, recording.size(), pairs.rectifies());
  StereoPair pair;
  StereoCamera camera;
  try {
    while (pairs.next(pair, camera)) {
      checks.observe(pair, camera);
      options.on_pair();
    }
  } catch (const std::runtime_error& error) {
    if (checks.pairs() == 0) {
      addUnusable(error.what(), rig.report);
      return false;
    }
    rig.report.findings.push_back({"inputs",
                                   "recording",
                                   error.what(),
                                   "the rest was not read",
                                   "repair it, e.g. with `rosbag reindex`",
                                   Verdict::kAcceptable,
                                   0.9});
  }
  input.report(checks.camera(), pairs.leftOut(), pairs.rectifies(), rig.report);
  checks.report(rig);
  rig.measures.calibration = calibrationOf(recording, checks.camera(), pairs.rectifies(), options);
  return true;
}

}  // namespace

CheckedRig checkRig(Recording& recording, const RigCheckOptions& options) {
  CheckedRig rig;
  if (!checkPairs(recording, options, rig)) {
    RigCheckOptions with_baseline = options;
    with_baseline.parameters.node.baseline_m = sizeOfBaseline(recording);
    if (with_baseline.parameters.node.baseline_m > 0.0) checkPairs(recording, with_baseline, rig);
  }
  rig.report.title = "Rig check of " + recording.description();
  rig.report.sort();
  return rig;
}

}  // namespace rotrocc
