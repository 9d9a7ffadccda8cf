#include "input/stereo_intake.h"

#include <algorithm>
#include <utility>

#include "common/to_seconds.h"
#include "input/message_conversion.h"
#include "input/sent_calibration.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Number of infos kept for each side: those of an image arrive at about the same time.
constexpr std::size_t kInfos = 8;

/// A camera is logged again if it has changed by more, see StereoCamera::differenceTo(), but not
/// one whose calibration is refined while it drives.
constexpr double kLogAgain = 1e-3;

/// The newest info of a stamp; null if there is none.
sensor_msgs::CameraInfo::ConstPtr infoAt(
    const ros::Time& stamp, const std::deque<sensor_msgs::CameraInfo::ConstPtr>& infos) {
  const auto found = std::find_if(
      infos.rbegin(), infos.rend(), [&](const auto& info) { return info->header.stamp == stamp; });
  return found == infos.rend() ? nullptr : *found;
}

TopicReport reportOf(const TopicStatistics& statistics, TopicStatistics::Time now) {
  return {"",
          0,
          statistics.recent(now),
          statistics.total(),
          statistics.rate_hz(now),
          statistics.silent_s(now)};
}

}  // namespace

StereoIntake::StereoIntake(const NodeParameters& parameters,
                           DropLog& drops,
                           PairHandler on_pair,
                           Log log)
    : parameters_(parameters),
      drops_(drops),
      on_pair_(std::move(on_pair)),
      log_(std::move(log)),
      synchronizer_(parameters.max_stamp_difference_s,
                    static_cast<std::size_t>(parameters.queue_size)) {}

void StereoIntake::addImage(Side side,
                            const sensor_msgs::Image::ConstPtr& image,
                            const Arrival& arrival) {
  stream(side).image_statistics.add(arrival.time);
  try {
    const std::int64_t stamp_ns = toNanoseconds(image->header.stamp);
    const CameraClock::Verdict verdict = synchronizer_.clock(side).judge(stamp_ns, arrival);
    if (verdict.glitch) drop(side, *verdict.glitch);
    const auto held = std::exchange(stream(side).held, verdict.held ? image : nullptr);
    if (verdict.held_is_valid) match(side, held, arrival);
    follows_held_ = verdict.held_is_valid;
    if (!verdict.held) match(side, image, arrival);
    follows_held_ = false;
  } catch (const InputError& error) {
    drop(side, error);
  }
}

void StereoIntake::drop(Side side, const InputError& error) {
  drops_.add(error);
  if (error.reason() != DropReason::kStampRepeated) synchronizer_.ignoreMissingPartner(side);
}

void StereoIntake::match(Side side,
                         const sensor_msgs::Image::ConstPtr& image,
                         const Arrival& arrival) {
  const auto images = synchronizer_.add(side, image, arrival);
  drops_.set(DropReason::kNoPartner, synchronizer_.unmatched());
  drops_.set(DropReason::kPartnerDropped, synchronizer_.excused());
  if (!images) return;
  pairs_.add(arrival.time);
  if (waiting_) drops_.count(DropReason::kCameraInfoMissing);
  const std::int64_t age_ns = arrival.clock_ns - toNanoseconds(images->left->header.stamp);
  const double age_s = arrival.clock_ns == 0 ? 0.0 : toSeconds(age_ns);
  const CameraClock& clock = synchronizer_.clock(Side::kLeft);
  waiting_ = ReceivedPair{*images,
                          {},
                          arrival.time,
                          {},
                          age_s,
                          clock.setAt_ns(toNanoseconds(images->left->header.stamp)),
                          clock.stampScatter_s(),
                          follows_held_,
                          nullptr};
  logClock();
  handOver();
}

void StereoIntake::addInfo(Side side, const Info& info, const Arrival& arrival) {
  stream(side).info_statistics.add(arrival.time);
  std::deque<Info>& infos = stream(side).infos;
  infos.push_back(info);
  if (infos.size() > kInfos) infos.pop_front();
  useNewestInfos();
  handOver();
}

void StereoIntake::useNewestInfos() {
  if (left_.infos.empty() || right_.infos.empty()) return;
  for (auto left = left_.infos.rbegin(); left != left_.infos.rend(); ++left) {
    if (const Info right = infoAt((*left)->header.stamp, right_.infos)) return use(*left, right);
  }
  use(left_.infos.back(), right_.infos.back());
}

/// Without a camera if they are invalid.
void StereoIntake::use(const Info& left, const Info& right) {
  if (left == left_info_ && right == right_info_) return;
  left_info_ = left;
  right_info_ = right;
  try {
    const bool is_new = !calibration_ || !isSameCamera(*left, *calibrated_left_) ||
                        !isSameCamera(*right, *calibrated_right_);
    if (parameters_.rectify && is_new) {
      calibration_ = std::make_shared<const StereoCalibration>(
          toStereoCalibration(*left, *right, parameters_.baseline_m));
      calibrated_left_ = left;
      calibrated_right_ = right;
    }
    camera_ = toStereoCamera(*left, *right, parameters_.baseline_m);
    camera_error_.clear();
    drops_.forgetCameraError();
  } catch (const InputError& error) {
    camera_.reset();
    camera_error_ = error.what();
    drops_.add(error);
  }
}

void StereoIntake::handOver() {
  if (!waiting_) return;
  const Info left = infoAt(waiting_->images.left->header.stamp, left_.infos);
  const Info right = infoAt(waiting_->images.right->header.stamp, right_.infos);
  left&& right ? use(left, right) : useNewestInfos();
  if (!camera_) return;
  logCamera(*camera_);
  waiting_->camera = *camera_;
  waiting_->calibration = calibration_;
  ReceivedPair pair = std::move(*waiting_);
  waiting_.reset();
  const auto kept = std::make_shared<const ReceivedPair>(pair);
  pair.before = before_;
  before_.push_back(kept);
  if (before_.size() > kPairsBefore) before_.erase(before_.begin());
  on_pair_(std::move(pair));
}

void StereoIntake::logClock() {
  const std::int64_t set_ns = synchronizer_.clock(Side::kLeft).set_ns();
  const double step_s = toSeconds(set_ns - std::exchange(logged_set_ns_, set_ns));
  if (step_s == 0.0) return;
  log_.warn("the stamps of the left images stepped by " + fixedText(step_s, 3) +
            " s while images kept coming: the odometry continues; synchronize the camera's clock "
            "before the drive");
}

void StereoIntake::logCamera(const StereoCamera& camera) {
  if (logged_camera_.differenceTo(camera) <= kLogAgain) return;
  logged_camera_ = camera;
  has_raw_infos_ =
      !calibration_ && describeRawImages(*left_info_, *right_info_, parameters_.baseline_m);
  const std::string rectified = calibration_
                                    ? std::string("; raw images are rectified by K, R and D (") +
                                          calibration_->left.distortion.name() + ")"
                                    : "";
  log_.info("stereo camera from P: " + sizeText(camera.width, camera.height) + ", fx " +
            toText(camera.fx) + " px, baseline " + toText(camera.baseline_m) + " m" + rectified);
  for (const std::string& warning :
       {calibrationWarning(*left_info_, camera), baselineWarning(camera.baseline_m)}) {
    if (!warning.empty()) log_.warn(warning);
  }
}

InputReport StereoIntake::report(std::chrono::steady_clock::time_point now) const {
  InputReport report;
  report.left_image = reportOf(left_.image_statistics, now);
  report.right_image = reportOf(right_.image_statistics, now);
  report.left_info = reportOf(left_.info_statistics, now);
  report.right_info = reportOf(right_.info_statistics, now);
  report.recent_pairs = pairs_.recent(now);
  report.pairs_silent_s = pairs_.silent_s(now);
  const CameraClock& left = synchronizer_.clock(Side::kLeft);
  const CameraClock& right = synchronizer_.clock(Side::kRight);
  const auto period_ns = synchronizer_.period_ns();
  if (period_ns) report.period_s = toSeconds(*period_ns);
  report.skew = skewOf(left.stamps_ns(), right.stamps_ns(), period_ns);
  report.max_stamp_difference_s = parameters_.max_stamp_difference_s;
  report.tolerance_s = toSeconds(synchronizer_.tolerance_ns());
  report.stamp_age_s = left.age_s();
  report.stamp_scatter_s = left.stampScatter_s();
  report.arrival_scatter_s = left.arrivalScatter_s();
  if (left_.image_statistics.total() > 0 && right_.image_statistics.total() > 0) {
    const auto begin = std::max({now - TopicStatistics::kWindow,
                                 left_.image_statistics.startOfRun(),
                                 right_.image_statistics.startOfRun()});
    report.unmatched = {synchronizer_.unmatched(Side::kLeft).since(begin),
                        synchronizer_.unmatched(Side::kRight).since(begin),
                        pairs_.since(begin)};
  }
  report.camera_error = camera_error_;
  report.has_raw_infos = has_raw_infos_;
  if (const auto rejected = drops_.lastWithin(TopicStatistics::kWindow)) {
    report.rejected = rejected->what();
    if (rejected->reason() == DropReason::kImageNotOfCamera) report.camera_error = rejected->what();
  }
  report.waits_for_info = waiting_.has_value();
  return report;
}

}  // namespace rotrocc
