#include "input/stereo_intake.h"

#include <algorithm>
#include <utility>

#include "common/to_seconds.h"
#include "input/message_conversion.h"
#include "input/stamp_series.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Number of infos kept for each side: those of an image arrive at about the same time.
constexpr std::size_t kInfos = 8;

/// A camera is logged again if it has changed by more, see StereoCamera::differenceTo(), but not
/// one whose calibration is refined while it drives.
constexpr double kToldAgain = 1e-3;

/// The newest info of a stamp; null if there is none.
sensor_msgs::CameraInfo::ConstPtr infoAt(
    const ros::Time& stamp, const std::deque<sensor_msgs::CameraInfo::ConstPtr>& infos) {
  const auto found = std::find_if(
      infos.rbegin(), infos.rend(), [&](const auto& info) { return info->header.stamp == stamp; });
  return found == infos.rend() ? nullptr : *found;
}

TopicReport reportOf(const TopicStatistics& statistics, TopicStatistics::Time now) {
  TopicReport report;
  report.recent = statistics.recent(now);
  report.total = statistics.total();
  report.rate_hz = statistics.rate_hz(now);
  report.silent_s = statistics.silent_s(now);
  return report;
}

}  // namespace

StereoIntake::StereoIntake(const NodeParameters& parameters,
                           DropLog& drops,
                           PairHandler on_pair,
                           Log log,
                           double max_future_s)
    : parameters_(parameters),
      drops_(drops),
      on_pair_(std::move(on_pair)),
      log_(std::move(log)),
      left_("the left image", max_future_s),
      right_("the right image", max_future_s),
      synchronizer_(parameters.max_stamp_difference_s,
                    static_cast<std::size_t>(parameters.queue_size)),
      current_calibration_(parameters.baseline_m) {}

void StereoIntake::addImage(Side side,
                            const sensor_msgs::Image::ConstPtr& image,
                            const Arrival& arrival) {
  Stream& stream = side == Side::kLeft ? left_ : right_;
  const std::int64_t stamp_ns = toNanoseconds(image->header.stamp);
  stream.statistics.add(arrival.time);
  try {
    const StampGuard::Verdict verdict = stream.guard.check(stamp_ns, arrival.clock_ns);
    if (verdict.glitch) drop(side, *verdict.glitch);
    const auto held = std::exchange(stream.held, verdict.held ? image : nullptr);
    if (verdict.held_is_valid) match(side, held, arrival);
    if (!verdict.held) match(side, image, arrival);
  } catch (const InputError& error) {
    drop(side, error);
  }
}

void StereoIntake::drop(Side side, const InputError& error) {
  drops_.add(error);
  if (error.reason() != DropReason::kStampRepeated) synchronizer_.excusePartner(side);
}

void StereoIntake::match(Side side,
                         const sensor_msgs::Image::ConstPtr& image,
                         const Arrival& arrival) {
  const auto images = synchronizer_.add(side, image, arrival.time);
  drops_.set(DropReason::kNoPartner, synchronizer_.unmatched());
  drops_.set(DropReason::kPartnerDropped, synchronizer_.excused());
  for (const Side each : {Side::kLeft, Side::kRight}) {
    TopicStatistics& unmatched = (each == Side::kLeft ? left_ : right_).unmatched;
    while (unmatched.total() < synchronizer_.unmatched(each)) unmatched.add(arrival.time);
  }
  if (!images) return;
  pairs_.add(arrival.time);
  if (waiting_) drops_.count(DropReason::kCameraInfoMissing);
  const std::int64_t age_ns = arrival.clock_ns - toNanoseconds(images->left->header.stamp);
  const double age_s = arrival.clock_ns == 0 ? 0.0 : toSeconds(age_ns);
  waiting_ = ReceivedPair{*images, {}, arrival.time, {}, age_s, nullptr};
  handOver();
}

void StereoIntake::addInfo(Side side, const Info& info, const Arrival& arrival) {
  const bool left = side == Side::kLeft;
  (left ? left_info_statistics_ : right_info_statistics_).add(arrival.time);
  Infos& infos = left ? left_infos_ : right_infos_;
  infos.push_back(info);
  if (infos.size() > kInfos) infos.pop_front();
  useNewestInfos();
  handOver();
}

void StereoIntake::useNewestInfos() {
  if (left_infos_.empty() || right_infos_.empty()) return;
  for (auto left = left_infos_.rbegin(); left != left_infos_.rend(); ++left) {
    if (const Info right = infoAt((*left)->header.stamp, right_infos_)) return use(*left, right);
  }
  use(left_infos_.back(), right_infos_.back());
}

/// Without a camera if they are invalid.
void StereoIntake::use(const Info& left, const Info& right) {
  if (left == left_info_ && right == right_info_) return;
  left_info_ = left;
  right_info_ = right;
  try {
    if (parameters_.rectify) calibration_ = current_calibration_.of(left, right);
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
  const Info left = infoAt(waiting_->images.left->header.stamp, left_infos_);
  const Info right = infoAt(waiting_->images.right->header.stamp, right_infos_);
  if (left != nullptr && right != nullptr) {
    use(left, right);
  } else {
    useNewestInfos();
  }
  if (!camera_) return;
  tell(*camera_);
  waiting_->camera = *camera_;
  waiting_->calibration = calibration_;
  on_pair_(std::move(*waiting_));
  waiting_.reset();
}

void StereoIntake::tell(const StereoCamera& camera) {
  if (told_camera_.differenceTo(camera) <= kToldAgain) return;
  told_camera_ = camera;
  const std::string rectified = calibration_
                                    ? std::string("; raw images are rectified by K, R and D (") +
                                          calibration_->left.distortion.name() + ")"
                                    : "";
  log_.info("stereo camera from P: " + sizeText(camera.width, camera.height) + ", fx " +
            toText(camera.fx) + " px, baseline " + toText(camera.baseline_m) + " m" + rectified);
  const std::string warning = baselineWarning(camera);
  if (!warning.empty()) log_.warn(warning);
}

InputReport StereoIntake::report(std::chrono::steady_clock::time_point now) const {
  InputReport report;
  report.left_image = reportOf(left_.statistics, now);
  report.right_image = reportOf(right_.statistics, now);
  report.left_info = reportOf(left_info_statistics_, now);
  report.right_info = reportOf(right_info_statistics_, now);
  report.recent_pairs = pairs_.recent(now);
  report.pairs_silent_s = pairs_.silent_s(now);
  addStamps(report);
  if (left_.statistics.total() > 0 && right_.statistics.total() > 0) {
    const auto begin = std::max({now - TopicStatistics::kWindow,
                                 left_.statistics.startOfRun(),
                                 right_.statistics.startOfRun()});
    report.unmatched = {
        left_.unmatched.since(begin), right_.unmatched.since(begin), pairs_.since(begin)};
  }
  report.camera_error = camera_error_;
  if (const auto refused = drops_.lastWithin(TopicStatistics::kWindow)) {
    report.refused = refused->what();
    if (refused->reason() == DropReason::kImageNotOfCamera) report.camera_error = refused->what();
  }
  report.waits_for_info = waiting_.has_value();
  return report;
}

void StereoIntake::addStamps(InputReport& report) const {
  const StampSeries& left = synchronizer_.leftStamps();
  const StampSeries& right = synchronizer_.rightStamps();
  if (const auto period_ns = commonPeriod_ns(left, right)) {
    report.period_s = toSeconds(*period_ns);
  }
  report.stamp_difference_s = greatestStampDifference(left, right);
  report.max_stamp_difference_s = parameters_.max_stamp_difference_s;
  report.stamp_age_s = left_.guard.age_s();
  report.tolerance_s = synchronizer_.tolerance_s();
  report.median_skew_s = medianSkew(left, right);
  report.skew_of_a_period_s = skewOfAPeriod(left, right);
}

}  // namespace rotrocc
