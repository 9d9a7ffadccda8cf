#include "support/odometry_rig.h"

#include <cmath>
#include <utility>
#include <vector>

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>
#include <boost/make_shared.hpp>

#include "input/camera_calibration.h"
#include "input/message_conversion.h"
#include "input/to_text.h"
#include "node/health/odometry_health.h"
#include "support/synthetic_scene.h"

namespace rotrocc {
namespace {

using sensor_msgs::image_encodings::MONO8;

constexpr int kPairs = 40;
constexpr double kStep_m = 0.4;
constexpr std::chrono::milliseconds kPeriod(100);
constexpr double kMotionTolerance = 0.05;
constexpr double kRounding = 1e-9;

const SyntheticScene& scene() {
  static const SyntheticScene scene;
  return scene;
}

/// Rendered on first use.
const StereoPair& pairAt(int index) {
  static std::vector<std::optional<StereoPair>> pairs(kPairs);
  auto& pair = pairs.at(static_cast<std::size_t>(index));
  if (!pair) {
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    T_world_camera.translation().z() = kStep_m * index;
    pair = scene().render(T_world_camera, 0);
    SyntheticScene::addNoise(*pair, 1.0, static_cast<std::uint64_t>(index) + 1);
  }
  return *pair;
}

std::string tenths(double value) {
  return toText(0.1 * std::round(10.0 * value));
}

}  // namespace

OdometryRig::OdometryRig(const Parameters& parameters)
    : processor_(parameters),
      intake_(parameters.node, drops_, [this](const ReceivedPair& pair) { process(pair); }) {}

void OdometryRig::sendInfos(const InfoChange& change) {
  auto [left, right] = toCameraInfos(rectifiedCalibration(scene().camera()));
  if (change) change(left, right);
  const Arrival arrival = {now_, 0};
  intake_.addInfo(
      StereoIntake::Side::kLeft, boost::make_shared<sensor_msgs::CameraInfo>(left), arrival);
  intake_.addInfo(
      StereoIntake::Side::kRight, boost::make_shared<sensor_msgs::CameraInfo>(right), arrival);
}

sensor_msgs::Image OdometryRig::nextImage(StereoIntake::Side side) const {
  const StereoPair& pair = pairAt(next_);
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = "camera_left";
  const bool is_left = side == StereoIntake::Side::kLeft;
  return *cv_bridge::CvImage(header, MONO8, is_left ? pair.left : pair.right).toImageMsg();
}

void OdometryRig::sendImage(StereoIntake::Side side, const sensor_msgs::Image& image) {
  intake_.addImage(side,
                   boost::make_shared<sensor_msgs::Image>(image),
                   {now_, toNanoseconds(clock.value_or(stamp))});
}

void OdometryRig::advance() {
  next_ = (next_ + 1) % kPairs;
  stamp += ros::Duration(1e-3 * kPeriod.count());
  now_ += kPeriod;
}

void OdometryRig::drive(const ImageChange& change) {
  sensor_msgs::Image left = nextImage(StereoIntake::Side::kLeft);
  sensor_msgs::Image right = nextImage(StereoIntake::Side::kRight);
  if (change) change(left, right);
  sendImage(StereoIntake::Side::kLeft, left);
  sendImage(StereoIntake::Side::kRight, right);
  advance();
}

void OdometryRig::drivePairs(int count) {
  for (int i = 0; i < count; ++i) drive();
}

void OdometryRig::forget() {
  answer_.reset();
  state_before_ = state_;
  drops_before_.clear();
  for (const auto& [reason, count] : drops_.counts()) drops_before_[reason] = count;
}

std::string OdometryRig::observed() const {
  if (answer_) return describeAnswer();
  const std::string drops = describeDrops();
  return drops.empty() ? "no odometry" : drops;
}

std::string OdometryRig::describeAnswer() const {
  std::string text = toString(answer_->result.state);
  const UncertainTransform& pose = answer_->state.T_odom_base;
  if (answer_->result.hasMotion()) {
    const double moved_m = answer_->result.T_prev_cur.translation().norm();
    if (std::abs(moved_m - way_m_) > kMotionTolerance * way_m_) {
      text += ", moved " + tenths(moved_m) + " m of " + tenths(way_m_) + " m";
    }
  } else {
    const UncertainTransform& before = state_before_.T_odom_base;
    const bool held = pose.T.isApprox(before.T, kRounding);
    const bool zero = pose.T.isApprox(Eigen::Isometry3d::Identity(), kRounding);
    const double moved_m = (pose.T.translation() - before.T.translation()).norm();
    text += held ? ", pose held" : zero ? ", pose zero" : ", pose moved " + tenths(moved_m) + " m";
    if (pose.covariance(0, 0) > before.covariance(0, 0)) text += ", covariance grows";
    if (answer_->state.twist.covariance(0, 0) == kUnknownVariance) text += ", twist unknown";
  }
  return hint_.empty() ? text : text + ", hint: " + hint_;
}

std::string OdometryRig::describeDrops() const {
  std::string text;
  for (const auto& [reason, count] : drops_.counts()) {
    const auto before = drops_before_.find(reason);
    if (before != drops_before_.end() && before->second == count) continue;
    const auto last = drops_.lastWithin(std::chrono::seconds(60));
    const bool has_sentence = last && last->reason() == reason;
    text += (text.empty() ? "" : "; ") + std::string("dropped (") + toString(reason) + ")" +
            (has_sentence ? std::string(": ") + last->what() : "");
  }
  return text;
}

std::string OdometryRig::stateWithoutAnswers() const {
  return stateName(OdometryHealth().report(report(), drops_).state);
}

InputReport OdometryRig::report() const {
  InputReport report = intake_.report(now_);
  report.left_image.topic = "left/image_rect";
  report.right_image.topic = "right/image_rect";
  report.left_info.topic = "left/camera_info";
  report.right_info.topic = "right/camera_info";
  return report;
}

void OdometryRig::process(const ReceivedPair& pair) {
  try {
    PairInput in = {processor_.convert(pair), pair.arrival, pair.camera, T_base_camera};
    in.before = pair.before;
    if (expected && last_stamp_ns_ && in.pair.stamp_ns > *last_stamp_ns_) {
      in.T_last_base = expected(*last_stamp_ns_, in.pair.stamp_ns);
    }
    last_stamp_ns_ = in.pair.stamp_ns;
    in.is_simulated = is_simulated;
    processor_.takeRequests();
    answer_ = processor_.process(in);
    left_ = in.pair.left;
    hint_ = processor_.inspect(in);
    processor_.finishInspection();
    ++answers_;
    state_ = answer_->state;
    const double place_m = kStep_m * next_;
    way_m_ = std::abs(place_m - std::exchange(last_place_m_, place_m));
  } catch (const InputError& error) {
    drops_.add(error);
  }
}

}  // namespace rotrocc
