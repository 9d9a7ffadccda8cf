#include "check/rig_check.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "bags/recorded_pairs.h"
#include "check/input_check.h"
#include "check/model_check.h"
#include "check/rig_sampler.h"
#include "common/to_seconds.h"
#include "input/to_text.h"
#include "motion/feature_errors.h"
#include "node/health/recording_inspector.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {
namespace {

const char* const kCalibrateAgain =
    "recalibrate the pair: K, D, R or P of camera_info belong to another lens, or the distortion "
    "model does not suit the lens";
const char* const kRectify =
    "the images are not rectified, or with another calibration: use the topics `image_rect`, or "
    "set `rectify` for raw images; otherwise recalibrate the pair";

/// All checks of the pairs of one recording.
class PairChecks {
 public:
  PairChecks(const OdometryConfig& config,
             const std::optional<GyroRecording>& gyroscope,
             bool rectifies)
      : odometry_(config), rectifies_(rectifies), inspector_(config, rectifies), sampler_(config) {
    checks_.push_back(makePhotometryCheck());
    checks_.push_back(makeViewCheck());
    checks_.push_back(makeDetailCheck());  // after the view, whose mask explains a lack of detail
    if (gyroscope) checks_.push_back(makeGyroCheck(*gyroscope));
  }

  void observe(const StereoPair& pair, const StereoCamera& camera) {
    constexpr double kSameCamera = 1e-3;  // see StereoCamera::differenceTo()
    if (pairs_ == 0) {
      first_ns_ = pair.time_ns();
      camera_ = camera;
    }
    if (camera_.differenceTo(camera) > kSameCamera) {
      ++of_other_camera_;
      return;
    }
    if (pairs_ > 0 && pair.time_ns() <= last_ns_) odometry_.reset();
    last_ns_ = pair.time_ns();
    ++pairs_;
    const OdometryResult result = odometry_.process(pair, camera);
    with_motion_ += result.hasMotion() ? 1 : 0;
    camera_.detail_px = result.detail_px();
    ok_ += result.state == State::kOk ? 1 : 0;
    if (result.hasMotion()) applied_px_ = result.disparity_bias.applied_px;
    path_m_ += result.T_prev_cur.translation().norm();
    const double flow_px =
        result.hasMotion() ? medianFlow_px(odometry_.correspondences(), odometry_.rotationInliers())
                           : 0.0;
    const CheckedPair checked = {toSeconds(last_ns_ - first_ns_),
                                 pair,
                                 camera,
                                 result,
                                 odometry_.correspondences(),
                                 odometry_.rotationInliers(),
                                 flow_px,
                                 result.hasMotion() && hasMoved(result, flow_px)};
    if (result.state == State::kLost) {
      ++lost_;
      if (++losses_[result.reason] > losses_[commonest_loss_]) commonest_loss_ = result.reason;
    }
    countRepeated(pair);
    if (const auto fault = inspector_.inspect(pair, camera, result); !fault.empty()) {
      fault_ = fault;
      is_of_no_pair_ = inspector_.inspector().isOfNoPair();
      is_of_loss_ = !inspector_.inspector().finish().empty();
    }
    sampler_.observe(checked);
    for (const auto& check : checks_) check->observe(checked);
    if (left_.empty() || (result.hasMotion() && with_motion_ == 1)) {  // for the pictures
      left_ = pair.left.clone();
      right_ = pair.right.clone();
    }
  }

  void report(CheckedRig& rig) {
    RigReport& report = rig.report;
    const double length_s = toSeconds(last_ns_ - first_ns_);
    const Windows windows(length_s, static_cast<std::size_t>(pairs_));
    report.summary = toText(pairs_) + " pairs in " + fixedText(length_s, 1) + " s, " +
                     fixedText(path_m_, 1) + " m; " + sizeText(camera_.width, camera_.height) +
                     ", focal length " + fixedText(camera_.fx, 1) + " px, baseline " +
                     fixedText(camera_.baseline_m, 3) + " m";
    addOtherCamera(report);
    addRepeated(report);
    addLost(report);
    const std::vector<PairSamples>& samples = sampler_.pairs();
    if (!isMostlyLost()) {
      for (const auto& check : checks_) check->report(windows, report);
      if (!report.mask.empty()) sampler_.exclude(report.mask);
      const RigModel& model = rig.measures.model = fitRig(camera_, samples, windows);
      rig.measures.rest = checkModel(camera_, samples, model, windows, applied_px_, report);
      // Most motions, or a quarter if images are no pairs, are in doubt because of the fault.
      const bool fits = !is_of_no_pair_ && rig.measures.rest.isMostlyExplained();
      is_explained_ = is_of_loss_ && !fits && (is_of_no_pair_ ? 4 : 2) * (pairs_ - ok_) > pairs_;
      if (is_explained_) {
        doubt(report);
      } else {
        const bool is_of_lens = model.exceeds(1.0, kBothLenses) || model.exceeds(1.0, kLens);
        rig.measures.is_known = (is_of_lens || !addCenter(model, report)) &&
                                !addRectification(rig.measures.rest, model, report);
      }
    }
    addFault(report);
    if (samples.size() < kLeastMotions) {
      doubt(report);
      report.findings.push_back(
          {"inputs",
           "length of the recording",
           "features moved in " + toText(samples.size()) + " of " + toText(pairs_) + " pairs",
           "each pair has its own errors, so a few pairs are not enough",
           "record a minute of motion, with turns",
           Verdict::kUnknown,
           100.0});
    }
    report.left = left_;
    report.right = right_;
    rig.measures.pairs_with_motion = with_motion_;
    rig.measures.moving_pairs = static_cast<int>(samples.size());
  }

  const StereoCamera& camera() const { return camera_; }
  int pairs() const { return pairs_; }

 private:
  /// `flow_px`: median of the features between the keyframe and this pair, which has a motion. A
  /// keyframe is kept while features rest, so that noise does not add up to a way.
  bool hasMoved(const OdometryResult& result, double flow_px) {
    // In pixels of detail: matches of the same texture in the same part of a pixel have the same
    // errors.
    constexpr double kMoved = 2.0;
    if (result.keyframe_stamp_ns != keyframe_stamp_ns_) keyframe_at_px_ = at_px_;
    keyframe_stamp_ns_ = result.keyframe_stamp_ns;
    at_px_ = keyframe_at_px_ + flow_px;
    if (std::abs(at_px_ - taken_at_px_) < kMoved * result.detail_px()) return false;
    taken_at_px_ = at_px_;
    return true;
  }

  bool isMostlyLost() const { return 2 * with_motion_ < pairs_; }

  /// What is not good in the sections of measurements is unknown.
  static void doubt(RigReport& report) {
    for (Finding& finding : report.findings) {
      if (finding.section == "inputs" || finding.section == "photometry") continue;
      if (finding.subject == kMasked) continue;
      if (finding.verdict == Verdict::kGood) continue;
      finding.verdict = Verdict::kUnknown;
      finding.cost.clear();
      finding.remedy.clear();
    }
  }

  /// Returns whether the principal points of both images are wrong. What follows is not reported
  /// then.
  bool addCenter(const RigModel& model, RigReport& report) const {
    const Estimate x = model.value(kBothX), y = model.value(kBothY);
    if (x.value == 0.0 && y.value == 0.0) return false;
    const Estimate in_x = model.severity(kBothX), in_y = model.severity(kBothY);
    const Estimate severity = in_x.certain() > in_y.certain() ? in_x : in_y;
    const bool is_wrong = severity.certain() > 1.0;
    if (is_wrong) doubt(report);
    const double turned = std::hypot(x.value / camera_.fx, y.value / camera_.fy);
    report.add(
        {"inputs",
         "principal points",
         "wrong in both cameras: by " + toText(x, "px") + " in x, " + toText(y, "px") + " in y",
         "motions are rotated by " + fixedText(turned * 180.0 / M_PI, 1) + " deg",
         "calibrate the images as they are: were they cropped after the calibration?"},
        {severity, kAcceptable, 1.0});
    return is_wrong;
  }

  /// Returns whether it is wrong: what is left when nothing else explains the rows, or lenses that
  /// are not corrected. What follows from them is not reported.
  bool addRectification(const ModelRest& rest, const RigModel& model, RigReport& report) const {
    // Parts of the robot disturb the motions, which looks like such lenses.
    const bool is_raw = report.mask.empty() && model.exceeds(1.0, kBothLenses);
    const bool is_unexplained =
        rest.unexplained_px.certain() > model.fix_rows_px &&
        std::none_of(report.findings.begin(), report.findings.end(), [](const Finding& finding) {
          return (finding.verdict == Verdict::kFix && finding.section == "photometry") ||
                 (finding.verdict <= Verdict::kAcceptable && finding.subject == kRowsOverTime);
        });
    if (!is_raw && !is_unexplained) return false;
    doubt(report);
    const std::string measured =
        is_raw ? "both images have radial distortion, k1 = " + toText(model.value(kBothLenses), "")
               : "rows differ by " + fixedText(rest.rows_px, 2) + " px (rms), of which " +
                     toText(rest.unexplained_px, "px") +
                     " have a shape that rectified cameras cannot cause";
    report.add({"inputs",
                "rectification",
                measured,
                "depths and motions are wrong, no matter how many features agree",
                rectifies_ ? kCalibrateAgain : kRectify},
               kToFix);
    return true;
  }

  void addLost(RigReport& report) const {
    report.add({"odometry",
                "lost pairs",
                toText(lost_) + " of " + toText(pairs_) +
                    (lost_ > 0 ? ", most often because " + commonest_loss_ : ""),
                "the motion between them is missing",
                "see the findings above; light, texture and turning speed matter most"},
               {{static_cast<double>(lost_) / pairs_}, 0.001, 0.03});
  }

  /// Whether a driver sends what it has sent before. Noise alone makes images differ.
  void countRepeated(const StereoPair& pair) {
    if (inspector_.before().empty()) return;
    const StereoPair& before = inspector_.before().back();
    const auto repeats = [](const cv::Mat& image, const cv::Mat& earlier) {
      return image.size() == earlier.size() && cv::norm(image, earlier, cv::NORM_INF) == 0.0;
    };
    repeated_left_ += repeats(pair.left, before.left) ? 1 : 0;
    repeated_right_ += repeats(pair.right, before.right) ? 1 : 0;
  }

  void addRepeated(RigReport& report) const {
    if (pairs_ < 2) return;
    const double most = static_cast<double>(std::max(repeated_left_, repeated_right_)) / pairs_;
    const bool both = repeated_left_ == repeated_right_;
    report.add({"inputs",
                "repeated images",
                toText(repeated_left_) + " left and " + toText(repeated_right_) + " right of " +
                    toText(pairs_) + " repeat the previous one",
                both ? "the motion stops and then jumps" : "the images are of different times",
                "look for a driver that resends its last buffer, or a camera that hangs"},
               {{most}, 0.0, 0.02});
  }

  void addOtherCamera(RigReport& report) const {
    if (of_other_camera_ == 0) return;
    report.add({"inputs",
                "calibration",
                toText(of_other_camera_) + " of " + toText(of_other_camera_ + pairs_) +
                    " pairs have a different calibration or size than the first",
                "they were not checked",
                "check each part of the recording separately"},
               kToLookAt);
  }

  void addFault(RigReport& report) {
    const std::string single = inspector_.faultOfSinglePairs();
    if (fault_.empty()) fault_ = single.empty() && isMostlyLost() ? commonest_loss_ : single;
    if (fault_.empty()) return;
    const std::size_t colon = fault_.find(": ");
    report.add({"inputs",
                "left and right images",
                fault_.substr(0, colon),
                toText(pairs_ - ok_) + " of " + toText(pairs_) +
                    " pairs have no motion estimate or a doubtful one" +
                    (isMostlyLost() ? ", so that nothing else can be measured" : ""),
                colon == std::string::npos ? "" : fault_.substr(colon + 2)},
               isMostlyLost() || is_explained_ || fault_ == single ? kToFix : kToLookAt);
  }

  VisualOdometry odometry_;
  bool rectifies_;
  RecordingInspector inspector_;
  RigSampler sampler_;
  std::vector<std::unique_ptr<PairCheck>> checks_;
  StereoCamera camera_;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  int pairs_ = 0, of_other_camera_ = 0, with_motion_ = 0, ok_ = 0, lost_ = 0, repeated_left_ = 0,
      repeated_right_ = 0;
  double path_m_ = 0.0, applied_px_ = 0.0;
  std::string fault_;
  std::map<std::string, int> losses_;  // by reason
  std::string commonest_loss_;
  bool is_of_loss_ = false, is_of_no_pair_ = false, is_explained_ = false;
  // How far the features have come, also at the keyframe and at the last pair that was new.
  double at_px_ = 0.0, keyframe_at_px_ = 0.0, taken_at_px_ = 0.0;
  std::int64_t keyframe_stamp_ns_ = 0;
  cv::Mat left_, right_;
};

}  // namespace

CheckedRig checkRig(Recording& recording, const RigCheckOptions& options) {
  RecordedPairs pairs(recording, options.parameters.node, options.rectify, options.calibration);
  InputCheck input;
  pairs.onMessage([&](const RecordedMessage& message) { input.observe(message); });
  PairChecks checks(options.parameters.odometry, options.gyroscope, pairs.rectifies());
  CheckedRig rig;
  RigReport& report = rig.report;
  report.title = "Rig check of " + recording.description();
  StereoPair pair;
  StereoCamera camera;
  std::string failure;
  try {
    while (pairs.next(pair, camera)) {
      if (checks.pairs() == 0) rig.measures.calibration = pairs.calibration();
      checks.observe(pair, camera);
      options.on_pair();
    }
  } catch (const std::runtime_error& error) {
    failure = error.what();
  }
  input.reportStreams(options.parameters.node.max_stamp_difference_s, report);
  if (checks.pairs() > 0) {
    input.report(checks.camera(), pairs.leftOut(), pairs.rectifies(), report);
    checks.report(rig);
    if (!failure.empty()) {
      report.add({"inputs",
                  "recording",
                  failure,
                  "the rest was not read",
                  "repair it, e.g. with `rosbag reindex`"},
                 kToLookAt);
    }
  } else if (!report.needsFix()) {
    const std::size_t end = failure.rfind(": ");
    report.add({"inputs",
                "pairs",
                failure.substr(0, end),
                "no pair can be used",
                end == std::string::npos ? "" : failure.substr(end + 2)},
               kToFix);
  }
  report.sort();
  return rig;
}

}  // namespace rotrocc
