#include "check/replay_check.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/core.hpp>

#include "common/median.h"
#include "input/to_text.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {
namespace {

constexpr std::size_t kPairs = 40;  // of a stretch
constexpr int kStretches = 8;       // that are repeated
constexpr double kDegrees = 180.0 / M_PI;

/// Over a shorter way, differences are compared with what is promised only.
constexpr double kLeastPath_m = 1.0;

StereoPair mirrored(const StereoPair& pair) {
  StereoPair result;
  result.stamp_ns = pair.stamp_ns;
  cv::flip(pair.right, result.left, 1);
  cv::flip(pair.left, result.right, 1);
  if (!pair.right_mask.empty()) cv::flip(pair.right_mask, result.left_mask, 1);
  if (!pair.left_mask.empty()) cv::flip(pair.left_mask, result.right_mask, 1);
  return result;
}

StereoCamera mirrored(const StereoCamera& camera) {
  StereoCamera result = camera;
  result.cx = camera.width - 1 - camera.cx_right;
  result.cx_right = camera.width - 1 - camera.cx;
  return result;
}

/// The motion of the left camera, from that of the left camera of the mirrored rig, which is the
/// right one of the rig.
Eigen::Isometry3d unmirrored(const Eigen::Isometry3d& T, double baseline_m) {
  const Eigen::Vector3d flip(-1.0, 1.0, 1.0);
  Eigen::Isometry3d of_right = Eigen::Isometry3d::Identity();
  of_right.linear() = flip.asDiagonal() * T.linear() * flip.asDiagonal();
  of_right.translation() = flip.asDiagonal() * T.translation();
  const Eigen::Isometry3d T_left_right(Eigen::Translation3d(baseline_m, 0.0, 0.0));
  return T_left_right * of_right * T_left_right.inverse();
}

double angleOf(const Eigen::Isometry3d& T) {
  return Eigen::AngleAxisd(T.linear()).angle();
}

}  // namespace

ReplayCheck::ReplayCheck(const OdometryConfig& config, int pairs)
    : config_(config), repeated_of_(std::max(1, pairs / static_cast<int>(kPairs) / kStretches)) {
  config_.threads = 1;  // beside the odometry of the caller
}

void ReplayCheck::observe(const CheckedPair& pair) {
  ++pairs_;
  if (pair.result.state == State::kLost) ++lost_;
  if (pair.result.state == State::kLost || pair.result.state == State::kInitialising) {
    stretch_.clear();
    if (pair.result.state == State::kLost) return;
  }
  const bool is_repeated = stretches_ % repeated_of_ == 0;
  Step step = {pair.time_s,
               {pair.images.stamp_ns, {}, {}, pair.images.left_mask, pair.images.right_mask},
               pair.camera,
               pair.result};
  if (is_repeated) {
    step.images.left = pair.images.left.clone();
    step.images.right = pair.images.right.clone();
  }
  stretch_.push_back(std::move(step));
  if (stretch_.size() <= kPairs) return;
  if (is_repeated) startCompare();
  stretch_.clear();
  ++stretches_;
}

void ReplayCheck::startCompare() {
  finishCompare();
  comparison_ = std::async(std::launch::async, [stretch = std::move(stretch_), config = config_] {
    return compare(stretch, config);
  });
  stretch_ = {};
}

void ReplayCheck::finishCompare() {
  if (!comparison_.valid()) return;
  const std::optional<Difference> difference = comparison_.get();
  if (difference) differences_.push_back(*difference);
}

/// None if a motion is lost on another way.
std::optional<ReplayCheck::Difference> ReplayCheck::compare(const Stretch& stretch,
                                                            OdometryConfig config) {
  Difference difference;
  difference.time_s = stretch.front().time_s;
  UncertainTransform forward;
  for (std::size_t i = 1; i < stretch.size(); ++i) {
    const OdometryResult& result = stretch[i].result;
    forward = compose(forward, {result.T_prev_cur, result.covariance});
    difference.path_m += result.T_prev_cur.translation().norm();
  }
  // What the odometry knows of the rig, so that only the way differs.
  config.stereo_calibrator.bias_px = stretch.back().result.disparity_bias.applied_px;
  VisualOdometry backward(config);
  VisualOdometry mirror(config);
  Eigen::Isometry3d T_backward = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_mirrored = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < stretch.size(); ++i) {
    const Step& last = stretch[stretch.size() - 1 - i];
    StereoPair pair = last.images;
    pair.stamp_ns = -pair.stamp_ns;
    const OdometryResult back = backward.process(pair, last.camera);
    const OdometryResult other =
        mirror.process(mirrored(stretch[i].images), mirrored(stretch[i].camera));
    if (i > 0 && (!back.hasMotion() || !other.hasMotion())) return std::nullopt;
    T_backward = T_backward * back.T_prev_cur;
    T_mirrored = T_mirrored * other.T_prev_cur;
  }
  const Eigen::Isometry3d closed = forward.T * T_backward;
  const Eigen::Isometry3d apart =
      forward.T.inverse() * unmirrored(T_mirrored, stretch.front().camera.baseline_m);
  difference.backward_m = closed.translation().norm();
  difference.backward_rad = angleOf(closed);
  difference.mirrored_m = apart.translation().norm();
  difference.mirrored_rad = angleOf(apart);
  difference.sigma_m = std::sqrt(forward.covariance.topLeftCorner<3, 3>().trace());
  difference.sigma_rad = std::sqrt(forward.covariance.bottomRightCorner<3, 3>().trace());
  return difference;
}

void ReplayCheck::report(RigReport& report) {
  if (pairs_ == 0) return;
  constexpr std::size_t kLeastPairs = 10;
  if (differences_.empty() && !comparison_.valid() && stretch_.size() >= kLeastPairs)
    startCompare();
  finishCompare();
  const double lost = static_cast<double>(lost_) / pairs_;
  report.add({"odometry",
              "lost pairs",
              toText(lost_) + " of " + toText(pairs_),
              "the way between them is missing",
              "see the findings above; light, texture and speed of turns decide most"},
             {lost, 0.0, 0.001, 0.03});
  ReportTable table = {
      "stretches",
      "time_s,path_m,backward_m,backward_deg,mirrored_m,mirrored_deg,sigma_m,sigma_deg",
      {}};
  std::vector<double> backward, mirror, backward_sigmas, mirror_sigmas, promised;
  for (const Difference& d : differences_) {
    table.rows.push_back({d.time_s,
                          d.path_m,
                          d.backward_m,
                          kDegrees * d.backward_rad,
                          d.mirrored_m,
                          kDegrees * d.mirrored_rad,
                          d.sigma_m,
                          kDegrees * d.sigma_rad});
    backward_sigmas.push_back(d.backward_m / d.sigma_m);
    mirror_sigmas.push_back(d.mirrored_m / d.sigma_m);
    if (d.path_m < kLeastPath_m) continue;
    promised.push_back(std::sqrt(2.0) * d.sigma_m / d.path_m);  // of two motions
    backward.push_back(d.backward_m / d.path_m);
    mirror.push_back(d.mirrored_m / d.path_m);
  }
  report.tables.push_back(std::move(table));
  if (!mirror.empty()) {
    share_.value = std::hypot(median(mirror), median(backward));
    share_.sigma = median(promised) / std::sqrt(static_cast<double>(mirror.size()));
  }
  const auto add = [&](const char* subject,
                       std::vector<double>& shares,
                       std::vector<double>& sigmas,
                       const char* cause) {
    if (shares.empty()) {
      report.findings.push_back({"odometry",
                                 subject,
                                 "no stretch is long enough, without a loss",
                                 "",
                                 "record a minute of motion",
                                 Verdict::kUnknown});
      return;
    }
    const double share = median(shares);
    report.add({"odometry",
                subject,
                fixedText(100.0 * share, 2) + " m in 100 m, " + fixedText(median(sigmas), 2) +
                    " of a standard deviation of the covariance, over " + toText(shares.size()) +
                    (shares.size() == 1 ? " stretch" : " stretches"),
                "trajectories of this rig are no better than that",
                cause},
               {share, median(promised), 0.01, 0.03});
  };
  add("backward against forward",
      backward,
      backward_sigmas,
      "look at coverage, depths and the time skew: errors that depend on the direction");
  add("mirrored against straight",
      mirror,
      mirror_sigmas,
      "look at rows, disparities and sharpness: errors that left and right do not share");
}

}  // namespace rotrocc
