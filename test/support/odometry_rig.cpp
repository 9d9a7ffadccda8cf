#include "support/odometry_rig.h"

#include <vector>

#include <sensor_msgs/image_encodings.h>
#include <boost/make_shared.hpp>

#include "bags/kitti_mount.h"
#include "input/image_validation.h"
#include "input/message_conversion.h"
#include "support/synthetic_scene.h"

namespace rotrocc {
namespace {

constexpr int kPairs = 40;
constexpr double kStep_m = 0.4;
constexpr std::chrono::milliseconds kPeriod(100);

const SyntheticScene& scene() {
  static const SyntheticScene scene;
  return scene;
}

/// Rendered when first looked at.
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

sensor_msgs::Image toMessage(const cv::Mat& image, const ros::Time& stamp) {
  sensor_msgs::Image message;
  message.header.stamp = stamp;
  message.header.frame_id = "camera_left";
  message.encoding = sensor_msgs::image_encodings::MONO8;
  message.width = static_cast<std::uint32_t>(image.cols);
  message.height = static_cast<std::uint32_t>(image.rows);
  message.step = message.width;
  message.data.assign(image.datastart, image.dataend);
  return message;
}

sensor_msgs::CameraInfo toInfo(const StereoCamera& camera, double baseline_m) {
  sensor_msgs::CameraInfo info;
  info.width = static_cast<std::uint32_t>(camera.width);
  info.height = static_cast<std::uint32_t>(camera.height);
  info.P = {
      camera.fx, 0, camera.cx, -camera.fx * baseline_m, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0};
  return info;
}

}  // namespace

OdometryRig::OdometryRig(const Parameters& parameters)
    : parameters_(parameters),
      processor_(parameters),
      intake_(parameters.node, drops_, [this](const ReceivedPair& pair) { process(pair); }) {}

void OdometryRig::sendInfos(const InfoChange& change) {
  sensor_msgs::CameraInfo left = toInfo(scene().camera(), 0.0);
  sensor_msgs::CameraInfo right = toInfo(scene().camera(), scene().camera().baseline_m);
  if (change) change(left, right);
  const Arrival arrival = {now_, 0};
  intake_.addInfo(
      StereoIntake::Side::kLeft, boost::make_shared<sensor_msgs::CameraInfo>(left), arrival);
  intake_.addInfo(
      StereoIntake::Side::kRight, boost::make_shared<sensor_msgs::CameraInfo>(right), arrival);
}

sensor_msgs::Image OdometryRig::nextImage(StereoIntake::Side side) const {
  const StereoPair& pair = pairAt(next_);
  return toMessage(side == StereoIntake::Side::kLeft ? pair.left : pair.right, stamp);
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
  drops_before_.clear();
  for (const auto& [reason, count] : drops_.counters().nonZero()) drops_before_[reason] = count;
}

std::string OdometryRig::observed() const {
  if (answer_) {
    const std::string state = toString(answer_->result.state);
    return answer_->hint.empty() ? state : state + ", hint: " + answer_->hint;
  }
  std::string text;
  for (const auto& [reason, count] : drops_.counters().nonZero()) {
    const auto before = drops_before_.find(reason);
    if (before != drops_before_.end() && before->second == count) continue;
    const auto last = drops_.lastWithin(std::chrono::seconds(60));
    const bool has_sentence = last && last->reason() == reason;
    text += (text.empty() ? "" : "; ") + std::string("dropped (") + toString(reason) + ")" +
            (has_sentence ? std::string(": ") + last->what() : "");
  }
  return text.empty() ? "no odometry" : text;
}

void OdometryRig::process(const ReceivedPair& pair) {
  try {
    cameraFrameOf(*pair.images.left, parameters_.node.camera_frame);
    answer_ = processor_.process(pair, kittiMount(), expected);
  } catch (const InputError& error) {
    drops_.add(error);
  }
}

}  // namespace rotrocc
